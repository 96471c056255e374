// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "tsdf_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <gtest/gtest.h>

#include <limits>

using namespace pcl::cosection;

TEST (TsdfArguments, MemoryIsAsDocumented)
{
  VoxelGrid grid = test::cubeGrid (256, 0.01);
  const std::size_t voxels = grid.size ();
  TsdfOptions options;
  EXPECT_EQ (TsdfVolume::estimateBytes (grid, options), 8 * voxels);
  options.colour = true;
  EXPECT_EQ (TsdfVolume::estimateBytes (grid, options), 16 * voxels);
  options.foreground = true;
  EXPECT_EQ (TsdfVolume::estimateBytes (grid, options), 20 * voxels);
}

TEST (TsdfArguments, RefusesWhatIsNotValid)
{
  const double nan = std::numeric_limits<double>::quiet_NaN ();
  VoxelGrid grid = test::cubeGrid (8, 0.01);
  for (const double size : {0.0, -0.01, nan, std::numeric_limits<double>::infinity ()})
  {
    grid.voxel_size_m = size;
    EXPECT_THROW (TsdfVolume{grid}, InvalidArgument) << size;
  }
  grid = test::cubeGrid (8, 0.01);
  grid.dims = {8, 0, 8};
  EXPECT_THROW (TsdfVolume{grid}, InvalidArgument);
  grid.dims = {-8, -8, 8};
  EXPECT_THROW (TsdfVolume{grid}, InvalidArgument);
  grid.dims.setConstant (std::numeric_limits<int>::max ());
  EXPECT_THROW (TsdfVolume{grid}, InvalidArgument);
  grid = test::cubeGrid (8, 0.01);
  grid.origin_m.y () = nan;
  EXPECT_THROW (TsdfVolume{grid}, InvalidArgument);

  grid = test::cubeGrid (8, 0.01);
  for (const double bad : {0.0, -1.0, nan})
  {
    TsdfOptions options;
    options.truncation_vox = bad;
    EXPECT_THROW (TsdfVolume (grid, options), InvalidArgument);
    options = {};
    options.max_weight = bad;
    EXPECT_THROW (TsdfVolume (grid, options), InvalidArgument);
  }

  TsdfVolume volume (grid);
  const PinholeCamera camera = test::smallCamera ();
  EXPECT_THROW (volume.integrate (Image<float> (), PinholeCamera (), test::frontPose ()), InvalidArgument);
  EXPECT_THROW (volume.integrate (Image<float> (camera.height, camera.width), camera, test::frontPose ()),
                InvalidArgument);
  Image<float> torn = test::wallDepth (0.5f);
  torn.pixels.pop_back ();
  EXPECT_THROW (volume.integrate (torn, camera, test::frontPose ()), InvalidArgument);
  Eigen::Isometry3d pose = test::frontPose ();
  pose.translation ().x () = nan;
  EXPECT_THROW (volume.integrate (test::wallDepth (0.5f), camera, pose), InvalidArgument);
  pose = test::frontPose ();
  pose.linear () *= 1.1;
  EXPECT_THROW (volume.integrate (test::wallDepth (0.5f), camera, pose), InvalidArgument);

  const Image<float> weights (3, 3);
  const Image<std::uint16_t> labels (3, 3);
  const Picture colours (3, 3);
  TsdfPixels pixels;
  pixels.weights = &weights;
  EXPECT_THROW (volume.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels), InvalidArgument);
  pixels = {};
  pixels.labels = &labels;
  EXPECT_THROW (volume.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels), InvalidArgument);
  pixels = {};
  pixels.colours = &colours;
  EXPECT_THROW (volume.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels), InvalidArgument);
  EXPECT_THROW (volume.surfaceMesh (nan), InvalidArgument);
  EXPECT_THROW (volume.surfaceMesh (-1.0), InvalidArgument);
  for (const float w : volume.weights ())
    EXPECT_EQ (w, 0.0f);
}
