// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "tsdf_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

using namespace pcl::cosection;

namespace {

/** \brief A volume with distances, weights, colours and counts that differ from voxel to voxel. */
TsdfVolume
seenSphere ()
{
  const PinholeCamera camera = test::smallCamera ();
  VoxelGrid grid = test::cubeGrid (
      24, 1.0 / 128.0); // positions have no rounding error, so that colours are those of voxels
  grid.dims = {24, 20, 27};
  TsdfOptions options;
  options.colour = true;
  options.foreground = true;
  TsdfVolume volume (grid, options);
  Picture colours (camera.width, camera.height);
  Image<std::uint16_t> labels (camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      colours.at (u, v) = {static_cast<std::uint8_t> (u), static_cast<std::uint8_t> (v),
                           static_cast<std::uint8_t> (u * v)};
      labels.at (u, v) = static_cast<std::uint16_t> ((u / 5 + v / 7) % 2);
    }
  TsdfPixels pixels;
  pixels.colours = &colours;
  for (const auto& pose : test::posesAround (0.4))
  {
    const auto depth = test::renderDepth (test::sphereRay (0.06), camera, pose);
    volume.integrate (depth, camera, pose, pixels);
    volume.countForeground (depth, camera, pose, labels, 1);
  }
  return volume;
}

bool
sameBits (float a, float b)
{
  return std::memcmp (&a, &b, sizeof (float)) == 0;
}

/** \brief Expect voxel v of \a before as voxel v + offset of \a after, and all other voxels of \a after empty. */
void
expectMoved (const TsdfVolume& before, const TsdfVolume& after, const Eigen::Vector3i& offset)
{
  const VoxelGrid& old_grid = before.grid ();
  const VoxelGrid& grid = after.grid ();
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3i v = Eigen::Vector3i (i, j, k) - offset;
        const Eigen::Vector3d p = grid.center (i, j, k);
        const std::size_t index = grid.index (i, j, k);
        if (!old_grid.contains (v.x (), v.y (), v.z ()))
        {
          ASSERT_EQ (after.weights ()[index], 0.0f);
          ASSERT_TRUE (std::isnan (after.field ().values[index]));
          ASSERT_FALSE (after.foregroundProbability (p));
          continue;
        }
        const std::size_t old_index = old_grid.index (v.x (), v.y (), v.z ());
        const Eigen::Vector3d old_p = old_grid.center (v.x (), v.y (), v.z ());
        ASSERT_EQ (p, old_p);
        ASSERT_TRUE (sameBits (before.field ().values[old_index], after.field ().values[index]));
        ASSERT_TRUE (sameBits (before.weights ()[old_index], after.weights ()[index]));
        ASSERT_EQ (before.foregroundProbability (old_p), after.foregroundProbability (p));
        ASSERT_EQ (before.colour (old_p), after.colour (p));
      }
}

} // namespace

TEST (TsdfPlacement, GrowingKeepsEveryVoxel)
{
  const TsdfVolume before = seenSphere ();
  TsdfVolume volume = before;
  const Eigen::Vector3i offset (3, 0, 8);
  volume.grow (offset, {40, 20, 36});
  EXPECT_EQ (volume.grid ().dims, Eigen::Vector3i (40, 20, 36));
  expectMoved (before, volume, offset);
  volume.reframe (-offset, before.grid ().dims); // and back
  expectMoved (before, volume, Eigen::Vector3i::Zero ());
}

TEST (TsdfPlacement, GrowingRefusesToLoseVoxels)
{
  const TsdfVolume before = seenSphere ();
  TsdfVolume volume = before;
  EXPECT_THROW (volume.grow ({-1, 0, 0}, {40, 40, 40}), InvalidArgument);
  EXPECT_THROW (volume.grow ({0, 0, 1}, before.grid ().dims), InvalidArgument);
  EXPECT_THROW (volume.grow ({0, std::numeric_limits<int>::max (), 0}, {40, 40, 40}), InvalidArgument);
  EXPECT_THROW (volume.reframe ({0, 0, 0}, {40, 0, 40}), InvalidArgument);
  expectMoved (before, volume, Eigen::Vector3i::Zero ());
}

TEST (TsdfPlacement, ReframingDropsWhatIsOutside)
{
  const TsdfVolume before = seenSphere ();
  const Eigen::Vector3i dims (12, 30, 9);
  for (const Eigen::Vector3i& offset :
       {Eigen::Vector3i (-6, 4, -10), Eigen::Vector3i (5, -3, 2), Eigen::Vector3i (0, 0, 0)})
  {
    TsdfVolume volume = before;
    volume.reframe (offset, dims);
    expectMoved (before, volume, offset);
  }
  TsdfVolume volume = before;
  volume.reframe (Eigen::Vector3i::Constant (std::numeric_limits<int>::min () + 1), dims);
  for (const float w : volume.weights ())
    EXPECT_EQ (w, 0.0f);
}

TEST (TsdfPlacement, AGrownVolumeGoesOnAsIfItHadAlwaysBeenSo)
{
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.1, -0.1, -0.4});
  const auto depth = test::renderDepth (test::sphereRay (0.06), camera, pose);
  TsdfVolume small (test::cubeGrid (16, 0.01));
  TsdfVolume large (test::cubeGrid (24, 0.01));
  small.integrate (depth, camera, pose);
  large.integrate (depth, camera, pose);
  small.grow ({4, 4, 4}, {24, 24, 24});
  small.integrate (depth, camera, pose);
  large.integrate (depth, camera, pose);
  int compared = 0;
  for (std::size_t v = 0; v < large.weights ().size (); ++v)
    if (small.weights ()[v] == 2.0f && large.weights ()[v] == 2.0f)
    {
      EXPECT_NEAR (small.field ().values[v], large.field ().values[v], 2e-3); // a voxel may fall into the next pixel
      ++compared;
    }
  EXPECT_GT (compared, 100);
}
