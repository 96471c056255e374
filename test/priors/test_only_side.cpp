// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Behind the only side that was seen, if it is flat, its outline goes on.

#include "completion/scenes/completion_scene.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief The mesh of a thing on the table as a camera at that height before it sees it. */
TriangleMesh
seenHeadOn (const Distance& shape, double height_m)
{
  AnalyticScene scene;
  scene.add (0, halfSpace (table_plane));
  scene.add (1, shape);
  const RenderedView seen = scene.render (tableCamera (), lookAt ({0.0, -0.5, height_m}, {0.0, 0.0, 0.05}));
  const SceneResult result = complete (seen, optionsFor (voxel_m));
  EXPECT_TRUE (computeTopology (result.objects.at (0).mesh).closed_manifold);
  return result.objects.at (0).mesh;
}

/** \brief A shape whose front is the plane y = 0, for z in [0, 0.1 m]. */
Distance
prism (const std::string& outline, double depth_m)
{
  return [=] (const Eigen::Vector3d& p) {
    const double x = p.x (), z = p.z () - 0.05;
    const double across = outline == "square"  ? std::max (std::abs (x), std::abs (z)) - 0.05
                          : outline == "round" ? std::hypot (x, z) - 0.05
                          : outline == "triangle"
                              ? std::max (-z - 0.05, (2.0 * std::abs (x) + z - 0.05) / std::sqrt (5.0))
                              : std::numeric_limits<double>::quiet_NaN ();
    return std::max ({across, -p.y (), p.y () - depth_m});
  };
}

} // namespace

TEST (OnlySide, ItsOutlineGoesOnBehindIt)
{
  for (const auto& [outline, area_m2] :
       {std::pair ("square", 0.01), std::pair ("round", 0.0025 * M_PI), std::pair ("triangle", 0.005)})
  {
    const TriangleMesh mesh = seenHeadOn (prism (outline, 0.08), 0.05);
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      box.extend (vertex);
    const double depth_m = box.sizes ().y (), volume_m3 = computeMassProperties (mesh).volume_m3;
    std::printf ("%s: %.0f mm deep, %.2f of the prism's volume\n", outline, 1e3 * depth_m,
                 volume_m3 / (area_m2 * depth_m));
    EXPECT_GT (depth_m, 0.05) << outline;
    EXPECT_NEAR (volume_m3 / (area_m2 * depth_m), 1.0, 0.12) << outline;
  }
}

TEST (OnlySide, ItDoesNotWhereSpaceBehindItWasSeenFree)
{
  for (const double height_m : {0.15, 0.25})
  {
    const double volume_m3 = computeMassProperties (seenHeadOn (prism ("square", 0.01), height_m)).volume_m3;
    std::printf ("board from %.2f m above: %.2f of its volume\n", height_m, volume_m3 / 1e-4);
    EXPECT_LT (volume_m3, 3.0 * 1e-4); // its two voxels become more
  }
}
