// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "observed_box.h"

#include "pcl_cosection/priors/contact_prior.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector4d floor_plane (0.0, 0.0, 1.0, 0.0);
const Eigen::Vector3d from_the_front (0.0, -1.0, 1.0);

VoxelGrid
gridAroundTheFloor ()
{
  VoxelGrid grid;
  grid.voxel_size_m = 0.004;
  grid.dims = {80, 80, 40};
  grid.origin_m = {-0.158, -0.158, -0.038};
  return grid;
}

void
append (std::vector<OrientedPoint>& points, std::vector<OrientedPoint> more, const Eigen::Vector3d& by)
{
  for (OrientedPoint& p : more)
  {
    p.position += by.cast<float> ();
    points.push_back (p);
  }
}

/** \brief Whether the voxel next to the floor at (x, y) is in the patch. */
bool
rests (const std::vector<OrientedPoint>& points, double x, double y, const Eigen::AlignedBox3d& seen_free = {})
{
  const VoxelGrid grid = gridAroundTheFloor ();
  std::vector<std::uint8_t> free_space (grid.size (), 0);
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        free_space[grid.index (i, j, k)] = seen_free.contains (grid.center (i, j, k));
  const std::vector<std::uint8_t> patch = contactPatch (grid, floor_plane, points, Eigen::Vector3d::Zero (),
                                                        free_space);
  const Eigen::Vector3i at = *grid.nearest ({x, y, 0.0});
  return !patch.empty () && patch[grid.index (at.x (), at.y (), at.z ())] != 0;
}

} // namespace

TEST (ContactPrior, BoxRestsOnItsWholeUnderside)
{
  std::vector<OrientedPoint> points;
  append (points, observedBox ({0.08, 0.05, 0.03}, from_the_front), {0.0, 0.0, 0.03});
  for (const double y : {-0.04, 0.0, 0.04})
    for (const double x : {-0.07, 0.0, 0.07})
      EXPECT_TRUE (rests (points, x, y)) << x << ' ' << y;
  EXPECT_FALSE (rests (points, 0.0, 0.07));
  EXPECT_FALSE (rests (points, 0.1, 0.0));
}

TEST (ContactPrior, VehicleRestsOnItsWheels)
{
  std::vector<OrientedPoint> points;
  append (points, observedBox ({0.12, 0.06, 0.03}, from_the_front), {0.0, 0.0, 0.06}); // its body
  for (const double x : {-0.08, 0.08})
    append (points, observedBox ({0.016, 0.002, 0.02}, from_the_front), {x, -0.06, 0.02});
  EXPECT_TRUE (rests (points, 0.08, -0.06));
  EXPECT_FALSE (rests (points, 0.0, -0.06));
  EXPECT_FALSE (rests (points, 0.0, 0.0));
  EXPECT_FALSE (rests (points, 0.08, 0.0));
}

TEST (ContactPrior, CartRestsOnItsRollersIfLightIsSeenBetweenThem)
{
  std::vector<OrientedPoint> points;
  append (points, observedBox ({0.12, 0.06, 0.03}, {-1.0, -1.0, 1.0}), {0.0, 0.0, 0.07}); // its body
  append (points, observedBox ({0.02, 0.06, 0.02}, {-1.0, -1.0, 1.0}), {-0.05, 0.0, 0.02});
  EXPECT_TRUE (rests (points, -0.06, -0.05));
  EXPECT_TRUE (rests (points, 0.0, 0.0)); // as if it were a box
  // Free space on the near side, down to the margin above the floor.
  const Eigen::AlignedBox3d light (Eigen::Vector3d (-0.025, -0.07, 0.01), Eigen::Vector3d (0.025, 0.0, 0.04));
  EXPECT_TRUE (rests (points, -0.06, -0.05, light));
  EXPECT_FALSE (rests (points, 0.0, 0.0, light));
  EXPECT_FALSE (rests (points, 0.0, 0.03, light));
}

TEST (ContactPrior, LevelSurfaceCloseToThePlaneIsNoContact)
{
  std::vector<OrientedPoint> points;
  append (points, observedBox ({0.05, 0.05, 0.003}, Eigen::Vector3d::UnitZ ()), {0.0, 0.0, 0.003});
  EXPECT_FALSE (rests (points, 0.0, 0.0));
}
