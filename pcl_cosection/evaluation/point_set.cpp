// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "point_set.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <pcl/cosection/common/error.h>

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <cmath>
#include <string>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_for_spacing = 10000; // points of which the nearest other one is looked for

} // namespace

bool
isPointSet (const TriangleMesh& mesh)
{
  return mesh.triangles.empty () && !mesh.vertices.empty ();
}

void
requirePoints (const TriangleMesh& points)
{
  for (std::size_t n = 0; n < points.vertices.size (); ++n)
    if (!points.vertices[n].allFinite ())
      throw InvalidArgument ("point " + std::to_string (n) + " is not finite");
}

std::vector<double>
distancesToPoints (const TriangleMesh& points, const std::vector<Eigen::Vector3d>& from, int neighbour, int threads)
{
  if (points.vertices.size () < static_cast<std::size_t> (neighbour))
    throw DegenerateInput ("a set of points has " + std::to_string (points.vertices.size ()) + " points, at least " +
                           std::to_string (neighbour) + " are needed");
  requirePoints (points);
  search::KdTree<PointXYZ> tree;
  tree.setInputCloud (asCloud (points.vertices));
  std::vector<double> distances (from.size ());
  parallelFor (0, static_cast<int> (from.size ()), threads, [&] (int n) {
    Indices indices;
    std::vector<float> squared;
    const Eigen::Vector3f p = from[n].cast<float> ();
    tree.nearestKSearch (PointXYZ (p.x (), p.y (), p.z ()), neighbour, indices, squared);
    distances[n] = (points.vertices[indices.back ()].cast<double> () - from[n]).norm ();
  });
  return distances;
}

std::vector<Eigen::Vector3d>
somePoints (const TriangleMesh& points, std::size_t count)
{
  std::vector<Eigen::Vector3d> some;
  const std::size_t all = points.vertices.size ();
  for (std::size_t n = 0; n < std::min (all, count); ++n)
    some.push_back (points.vertices[count < all ? n * all / count : n].cast<double> ());
  return some;
}

double
spacingOf (const TriangleMesh& points, int threads)
{
  std::vector<double> distances = distancesToPoints (points, somePoints (points, most_for_spacing), 2, threads);
  return upperMedian (distances);
}

} // namespace pcl::cosection
