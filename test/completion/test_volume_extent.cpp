// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/scenes/completion_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Box of the centres of an object's voxels. */
Eigen::AlignedBox3d
volumeOf (const ObjectResult& object)
{
  const VoxelGrid& grid = object.signed_distance->grid;
  return {grid.origin_m, grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1)};
}

/** \brief Distance from the mesh to the volume's border, voxels. */
double
room (const ObjectResult& object)
{
  const Eigen::AlignedBox3d volume = volumeOf (object);
  double least = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3f& v : object.mesh.vertices)
    least = std::min (
        {least, (v.cast<double> () - volume.min ()).minCoeff (), (volume.max () - v.cast<double> ()).minCoeff ()});
  return least / object.signed_distance->grid.voxel_size_m;
}

class VolumeExtent : public testing::TestWithParam<Shape>
{};

} // namespace

/** \brief The volume must not bound a shape that hangs in the air without any other bound. */
TEST_P (VolumeExtent, HoldsTheHiddenBackOfWhatHangsInTheAir)
{
  AnalyticScene scene;
  scene.add (1, onTable (GetParam ()));
  const RenderedView seen = scene.render (tableCamera (), fromTheFront ());
  const ObjectResult object = complete (seen, optionsFor (voxel_m)).objects.at (0);
  ASSERT_EQ (object.error, "");
  EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
  EXPECT_GE (room (object), 4.0);
}

TEST_P (VolumeExtent, EndsBelowTheTable)
{
  const RenderedView seen = tableScene (GetParam ()).render (tableCamera (), fromAbove ());
  const ObjectResult object = complete (seen, optionsFor (voxel_m)).objects.at (0);
  EXPECT_LE (volumeOf (object).min ().z (), -3.0 * voxel_m);
  EXPECT_GE (volumeOf (object).min ().z (), -12.0 * voxel_m);
  EXPECT_GE (room (object), 4.0);
}

INSTANTIATE_TEST_SUITE_P (Shapes, VolumeExtent, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (VolumePadding, IsTakenAsGiven)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  CoSectionOptions options = optionsFor (voxel_m);
  options.padding = 0.5;
  const Eigen::AlignedBox3d volume = volumeOf (complete (seen, options).objects.at (0));
  Eigen::AlignedBox3d observed;
  for (const OrientedPoint& p : seen.points.at (1))
    observed.extend (p.position.cast<double> ());
  const double pad = options.padding * observed.sizes ().maxCoeff () + 2.0 * voxel_m;
  EXPECT_NEAR ((volume.sizes () - observed.sizes ()).minCoeff (), 2.0 * pad, 2.0 * voxel_m);
  EXPECT_NEAR ((volume.sizes () - observed.sizes ()).maxCoeff (), 2.0 * pad, 2.0 * voxel_m);
}
