// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "analytic_scene.h"

#include <pcl/cosection/surface/free_space_filter.h>

#include <pcl/point_types.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

// Shared by the tests of FreeSpaceFilter: a table with a ball and a box, seen from three sides.

namespace pcl::cosection::test {

using Points = pcl::PointCloud<pcl::PointXYZ>;

/** \brief The scene; the table is z = 0. */
inline AnalyticScene
tableScene ()
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, placed (sphere (0.06), Eigen::Vector3d (-0.08, 0.0, 0.06)));
  scene.add (2, placed (box ({0.05, 0.04, 0.07}), Eigen::Vector3d (0.08, 0.03, 0.07)));
  return scene;
}

/** \brief Poses of sensors around the table. */
inline std::vector<Eigen::Isometry3d>
tablePoses ()
{
  const Eigen::Vector3d middle (0.0, 0.0, 0.05);
  return {lookAt ({0.0, -0.6, 0.45}, middle), lookAt ({0.6, 0.2, 0.4}, middle), lookAt ({-0.5, 0.4, 0.5}, middle)};
}

/** \brief One view per pose. \param[in] noise standard deviation of depth, in multiples of depthNoiseSigma () */
inline std::vector<DepthView>
renderTable (const AnalyticScene& scene, double noise = 0.0,
             const std::vector<Eigen::Isometry3d>& poses = tablePoses ())
{
  std::mt19937 generator (7);
  std::normal_distribution<double> gauss (0.0, 1.0);
  std::vector<DepthView> views;
  for (const Eigen::Isometry3d& pose : poses)
  {
    views.push_back (scene.render (smallCamera (), pose).view);
    for (float& z : views.back ().depth)
      z += static_cast<float> (noise * depthNoiseSigma (z) * gauss (generator));
  }
  return views;
}

/** \brief The organised cloud of a depth image, in its sensor's frame or in the world's. */
inline Points
toCloud (const DepthView& view, bool world)
{
  Points cloud (view.camera.width, view.camera.height);
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
    {
      const Eigen::Vector3d p = view.camera.unproject (u, v, view.at (u, v));
      cloud (u, v).getVector3fMap () = (world ? view.T_world_sensor * p : p).cast<float> ();
    }
  cloud.is_dense = false;
  return cloud;
}

/** \brief The finite points of all views, in the world frame. */
inline Points::Ptr
merged (const std::vector<DepthView>& views)
{
  auto cloud = pcl::make_shared<Points> ();
  for (const DepthView& view : views)
    for (const auto& p : toCloud (view, true))
      if (std::isfinite (p.x))
        cloud->push_back (p);
  return cloud;
}

/** \brief Points of a ball above the table that does not exist. */
inline Points
ghosts (int count = 500)
{
  const Eigen::Vector3d centre (0.0, -0.08, 0.22);
  Points cloud;
  const double golden = M_PI * (3.0 - std::sqrt (5.0));
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - 2.0 * (i + 0.5) / count;
    const double s = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d d (s * std::cos (golden * i), s * std::sin (golden * i), z);
    const Eigen::Vector3f p = (centre + 0.03 * d).cast<float> ();
    cloud.push_back ({p.x (), p.y (), p.z ()});
  }
  return cloud;
}

inline void
addViews (const std::vector<DepthView>& views, FreeSpaceFilter<pcl::PointXYZ>& filter)
{
  for (const DepthView& view : views)
    filter.addView (view);
}

/** \brief Indices of the points that pass. */
inline pcl::Indices
passing (FreeSpaceFilter<pcl::PointXYZ>& filter, const Points::ConstPtr& cloud)
{
  filter.setInputCloud (cloud);
  pcl::Indices indices;
  filter.filter (indices);
  return indices;
}

} // namespace pcl::cosection::test
