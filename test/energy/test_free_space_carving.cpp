// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/analytic_scene.h"

#include "pcl_cosection/energy/constraints/hull_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double radius_m = 0.08;
constexpr double distance_m = 0.7;
constexpr double voxel_size_m = 0.004;
const PinholeCamera camera{160, 120, 140.0, 140.0, 79.5, 59.5};

/** \brief A ball in the middle of a large one that is seen from within. */
AnalyticScene
ballInRoom ()
{
  AnalyticScene scene;
  const Distance room = sphere (2.0);
  scene.add (0, [=] (const Eigen::Vector3d& p) { return -room (p); });
  scene.add (1, sphere (radius_m));
  return scene;
}

VoxelGrid
gridAboutBall ()
{
  constexpr int size = 56;
  VoxelGrid grid;
  grid.dims.setConstant (size);
  grid.voxel_size_m = voxel_size_m;
  grid.origin_m.setConstant (-0.5 * (size - 1) * voxel_size_m);
  return grid;
}

/** \brief Bounds from views all around the ball, whose poses are wrong by some pixels. */
std::vector<float>
boundsOf (int views, double pose_error_px)
{
  const AnalyticScene scene = ballInRoom ();
  const VoxelGrid grid = gridAboutBall ();
  FreeSpaceCarving carving (grid, true);
  std::mt19937 random (3);
  std::normal_distribution<double> error (0.0, pose_error_px / camera.fx);
  for (int n = 0; n < views; ++n)
  {
    const double angle = 2.0 * M_PI * n / views;
    const Eigen::Vector3d eye = distance_m * Eigen::Vector3d (std::cos (angle), std::sin (angle), 0.0);
    const DepthView seen = scene.render (camera, lookAt (eye, Eigen::Vector3d::Zero ()), 8.0).view;
    Eigen::Isometry3d believed = seen.T_world_sensor;
    believed.rotate (Eigen::AngleAxisd (error (random), Eigen::Vector3d::UnitX ()));
    believed.rotate (Eigen::AngleAxisd (error (random), Eigen::Vector3d::UnitY ()));
    carving.add (FreeSpaceView (seen), believed);
  }
  return carving.lowerBounds ();
}

/** \brief Mean of bound minus distance at voxels near the ball's equator, voxels; positive: the cut is too deep. */
double
meanExcess (const std::vector<float>& bounds)
{
  const VoxelGrid grid = gridAboutBall ();
  double sum = 0.0;
  int count = 0;
  for (int k = grid.dims.z () / 2 - 3; k < grid.dims.z () / 2 + 3; ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const double distance_vox = (grid.center (i, j, k).norm () - radius_m) / voxel_size_m;
        if (std::abs (distance_vox) > 0.5)
          continue;
        sum += bounds[grid.index (i, j, k)] - distance_vox;
        ++count;
      }
  return sum / count;
}

} // namespace

TEST (FreeSpaceCarving, TwoViewsCutAlongTheirSilhouettes)
{
  const VoxelGrid grid = gridAboutBall ();
  const std::vector<float> bounds = boundsOf (2, 0.0); // along x
  const int middle = grid.dims.x () / 2;
  double farthest_kept_vox = 0.0;
  for (int j = 0; j < grid.dims.y (); ++j)
    if (bounds[grid.index (middle, j, middle)] < 0.0f)
      farthest_kept_vox = std::max (farthest_kept_vox, std::abs (grid.center (middle, j, middle).y ()) / voxel_size_m);
  // The rays that touch the ball pass its middle plane a little outside.
  const double touching_vox = radius_m / std::sqrt (1.0 - std::pow (radius_m / distance_m, 2)) / voxel_size_m;
  const double pixel_vox = distance_m / camera.fx / voxel_size_m;
  EXPECT_NEAR (farthest_kept_vox, touching_vox - pixel_vox, 1.0);
}

TEST (FreeSpaceCarving, ManyNoisyViewsCutAsExactOnes)
{
  const double exact = meanExcess (boundsOf (40, 0.0));
  const double noisy = meanExcess (boundsOf (40, 0.5));
  EXPECT_NEAR (noisy, exact, 0.2);
  EXPECT_NEAR (exact, 0.0, 0.4);
}

TEST (FreeSpaceCarving, CutsDownToTheSurfaceOfAnotherBody)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({1.0, 0.0, 0.0, 0.0})); // its surface in the middle of the grid
  const DepthView seen = scene.render (camera, lookAt ({distance_m, 0.0, 0.0}, Eigen::Vector3d::Zero ()), 8.0).view;
  const VoxelGrid grid = gridAboutBall ();
  const int middle = grid.dims.x () / 2; // half a voxel before the surface
  const auto boundAt = [&] (int i, int body) {
    FreeSpaceCarving carving (grid, true);
    carving.add (FreeSpaceView (seen, std::vector<int> (seen.depth.size (), 7)), seen.T_world_sensor, body);
    return carving.lowerBounds ()[grid.index (i, middle, middle)];
  };
  EXPECT_GT (boundAt (middle + 1, 3), 0.0f);
  EXPECT_LT (boundAt (middle + 1, 7), 0.0f);
  EXPECT_LT (boundAt (middle - 2, 3), 0.0f);
}

TEST (FreeSpaceCarving, BandsOfAFewPixelsKeepTheWidthOfAWall)
{
  const VoxelGrid grid = gridAboutBall ();
  const int middle = grid.dims.x () / 2;
  for (const int width_px : {2, 4})
  {
    SCOPED_TRACE (width_px);
    const double pixel_m = distance_m / camera.fx;
    AnalyticScene scene;
    scene.add (0, halfSpace ({1.0, 0.0, 0.0, 1.0})); // a wall behind
    scene.add (1, box ({0.01, 0.5 * width_px * pixel_m, 0.5}));
    const Eigen::Isometry3d pose = lookAt ({distance_m, 0.0, 0.0}, Eigen::Vector3d::Zero ());
    const DepthView seen = scene.render (camera, pose, 8.0).view;
    FreeSpaceCarving carving (grid, true);
    carving.add (FreeSpaceView (seen), seen.T_world_sensor);
    const std::vector<float> bounds = carving.lowerBounds ();
    for (int k = 10; k < grid.dims.z () - 10; ++k)
    {
      int kept = 0;
      for (int j = 0; j < grid.dims.y (); ++j)
        kept += bounds[grid.index (middle, j, k)] < 0.0f;
      EXPECT_GE (kept, 1);
      EXPECT_LE (kept, width_px * pixel_m / voxel_size_m + 1.0);
    }
  }
}
