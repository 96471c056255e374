// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion_scene.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection::test {

constexpr double neighbour_voxel_m = 0.005;
constexpr double about_a_voxel = 1.5;

/** \brief A low box (1) and a tall one (2) behind it that touch, on a table. The data of the tall one are moved into
 * the low one by a number of voxels. */
inline RenderedView
touchingBoxes (double overlap_vox)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, placed (box ({0.05, 0.035, 0.04}), Eigen::Vector3d (0.0, -0.035, 0.04)));
  scene.add (2, placed (box ({0.05, 0.035, 0.06}), Eigen::Vector3d (0.0, 0.035, 0.06)));
  RenderedView seen = scene.render (tableCamera (), fromAbove ());
  for (OrientedPoint& p : seen.points[2])
    p.position.y () -= static_cast<float> (overlap_vox * neighbour_voxel_m);
  return seen;
}

/** \brief Largest depth of a vertex of either object inside the other, voxels. */
inline double
deepestPenetration (const SceneResult& result)
{
  double deepest = 0.0;
  for (int i = 0; i < 2; ++i)
    for (const Eigen::Vector3f& v : result.objects.at (i).mesh.vertices)
      if (const auto u = result.objects.at (1 - i).signed_distance->sample (v.cast<double> ()))
        deepest = std::max (deepest, static_cast<double> (-*u));
  return deepest / neighbour_voxel_m;
}

} // namespace pcl::cosection::test
