// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/fusion/association/data_association.h"
#include "pcl_cosection/fusion/association/instance_matching.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

/** \brief A wall at z = \a depth_m, seen by the camera that looks along z. */
TsdfVolume
wallAt (float depth_m)
{
  VoxelGrid grid;
  grid.dims = {64, 64, 64};
  grid.voxel_size_m = 0.02;
  grid.origin_m = {-0.64, -0.64, 0.4};
  TsdfOptions options;
  options.truncation_vox = 5.0;
  TsdfVolume volume (grid, options);
  const PinholeCamera camera{80, 60, 60.0, 60.0, 39.5, 29.5};
  volume.integrate (Image<float> (80, 60, depth_m), camera, Eigen::Isometry3d::Identity ());
  return volume;
}

} // namespace

TEST (DataAssociation, SharesOutWhatIsNearAndRefusesWhatWasSeenFree)
{
  const TsdfVolume far = wallAt (1.2f);
  const TsdfVolume near = wallAt (0.8f);
  const std::vector<AssociatedModel> models{{&far}, {&near}};
  const DataAssociation association;
  const float nan = std::numeric_limits<float>::quiet_NaN ();
  const std::vector<Eigen::Vector3f> points{{0, 0, 1.2f}, {0, 0, 0.8f},    {0, 0, 0.55f},
                                            {0, 0, 1.0f}, {nan, nan, nan}, {0, 0, 5.0f}};
  const PointAssignment assigned = association.assign (points, models);
  constexpr std::uint8_t none = PointAssignment::none;
  EXPECT_EQ (assigned.model, (std::vector<std::uint8_t>{0, 1, none, none, PointAssignment::no_point, none}));
  EXPECT_EQ (assigned.first, (std::vector<std::uint8_t>{1, 2, 2, 2, 0, 0}));
  for (std::size_t target = 0; target < models.size (); ++target)
  {
    const std::vector<float> p = association.probabilities (points, models, target);
    for (std::size_t n = 0; n < points.size (); ++n)
    {
      EXPECT_GE (p[n], 0.0f);
      EXPECT_EQ (p[n] > 0.9f, assigned.model[n] == target) << n;
    }
  }
  EXPECT_TRUE (association.evidence (models[0], points[2]).free);
  EXPECT_FALSE (association.evidence (models[1], points[0]).known); // behind what was seen
}

TEST (DataAssociation, TwoModelsAtOnePlaceShareAPoint)
{
  const TsdfVolume wall = wallAt (1.0f);
  const std::vector<AssociatedModel> models{{&wall}, {&wall}};
  const std::vector<Eigen::Vector3f> points{{0, 0, 1.0f}};
  const DataAssociation association;
  const float p = association.probabilities (points, models, 0)[0];
  EXPECT_FLOAT_EQ (p, association.probabilities (points, models, 1)[0]);
  EXPECT_LT (p, 0.5f);
  EXPECT_GT (p, 0.45f);
  // The likelihood at the surface is alpha / (2 sigma).
  EXPECT_NEAR (association.evidence (models[0], points[0]).likelihood, 0.8 / 0.04, 0.5);
}

TEST (DataAssociation, OptionsAreChecked)
{
  AssociationOptions options;
  options.inlier_share = 1.0;
  EXPECT_THROW (DataAssociation{options}, InvalidArgument);
  options = AssociationOptions ();
  options.sigma_m = 0.0;
  EXPECT_THROW (DataAssociation{options}, InvalidArgument);
}

TEST (MaskMatching, LargestOverlapsFirstAndOneToOne)
{
  Image<std::uint16_t> mask (10, 4), rendered (10, 4);
  const Image<float> depth (10, 4, 1.0f);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 10; ++u)
    {
      mask.at (u, v) = u < 6 ? 7 : u < 8 ? 9 : 0;
      rendered.at (u, v) = u < 5 ? 2 : u == 5 ? 3 : 0;
    }
  const MaskMatches matches = matchMasks (mask, rendered, depth, 0.2);
  EXPECT_EQ (matches.object_of, (std::map<std::uint16_t, std::uint16_t>{{7, 2}}));
  EXPECT_EQ (matches.instance_pixels.at (9), 8u);
  EXPECT_EQ (matches.object_pixels.at (3), 4u);
  EXPECT_TRUE (matchMasks (mask, rendered, depth, 0.9).object_of.empty ());
  const Image<float> none (10, 4, std::numeric_limits<float>::quiet_NaN ());
  EXPECT_TRUE (matchMasks (mask, rendered, none, 0.2).instance_pixels.empty ());
  EXPECT_THROW (matchMasks (mask, Image<std::uint16_t> (4, 4), depth, 0.2), InvalidArgument);
}

TEST (FreeSpace, IsAveragedInFromOtherPixelsOnly)
{
  VoxelGrid grid;
  grid.dims = {32, 32, 32};
  grid.voxel_size_m = 0.02;
  grid.origin_m = {-0.31, -0.31, 0.6};
  TsdfOptions options;
  options.truncation_vox = 4.0;
  TsdfVolume volume (grid, options);
  const PinholeCamera camera{80, 60, 60.0, 60.0, 39.5, 29.5};
  Image<std::uint16_t> labels (80, 60);
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 40; ++u)
      labels.at (u, v) = 3;
  volume.integrateFreeSpace (Image<float> (80, 60, 1.0f), camera, Eigen::Isometry3d::Identity (), labels, 3);
  const auto weightAt = [&] (double x, double z) { return volume.weight ({x, 0.0, z}); };
  EXPECT_EQ (weightAt (0.1, 0.7), 1.0f);
  EXPECT_EQ (weightAt (-0.1, 0.7), 0.0f); // its own pixels
  EXPECT_EQ (weightAt (0.1, 0.97), 0.0f); // near the surface
  EXPECT_EQ (weightAt (0.1, 1.1), 0.0f);
  for (std::size_t n = 0; n < grid.size (); ++n)
    if (volume.weights ()[n] > 0.0f)
    {
      EXPECT_FLOAT_EQ (volume.field ().values[n], static_cast<float> (volume.truncation ()));
    }
  EXPECT_THROW (volume.integrateFreeSpace (Image<float> (80, 60, 1.0f), camera, Eigen::Isometry3d::Identity (),
                                           Image<std::uint16_t> (4, 4), 3),
                InvalidArgument);
}
