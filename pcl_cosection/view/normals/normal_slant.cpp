// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "normal_agreement.h"

#include "estimated_normals.h"

#include <Eigen/Eigenvalues>

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <cstddef>

namespace pcl::cosection {
namespace {

constexpr int neighbours = 16;
constexpr std::size_t judged_points = 2000;
constexpr double flatness = 0.1;   // smallest over second eigenvalue of what is flat; noise alone is not
constexpr double least_flat = 0.1; // share of the points, to judge by

} // namespace

double
slantOfNormals (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals)
{
  if (points.size () < static_cast<std::size_t> (neighbours))
    return 0.0;
  search::KdTree<PointXYZ> tree;
  tree.setInputCloud (asCloud (points));
  const std::size_t step = points.size () / judged_points + 1;
  std::size_t judged = 0, flat = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size (); i += step)
  {
    Indices indices;
    std::vector<float> squared;
    tree.nearestKSearch (static_cast<int> (i), neighbours, indices, squared);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
    for (const int k : indices)
      mean += points[k].cast<double> () / static_cast<double> (indices.size ());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero ();
    for (const int k : indices)
      scatter += (points[k].cast<double> () - mean) * (points[k].cast<double> () - mean).transpose ();
    const Eigen::Vector3d normal = normals[i].cast<double> ().normalized ();
    if (!normal.allFinite ())
      continue;
    ++judged;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes (scatter, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d values = axes.eigenvalues ();
    if (!(values[0] < flatness * values[1]))
      continue;
    ++flat;
    sum += 2.0 * normal.dot (scatter * normal) / (values[1] + values[2]);
  }
  return static_cast<double> (flat) < least_flat * static_cast<double> (judged) || flat == 0
             ? 0.0
             : sum / static_cast<double> (flat);
}

} // namespace pcl::cosection
