// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "neighbour_scene.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace
{

class Neighbours : public testing::TestWithParam<int> // voxels by which the data of one is pushed into the other
{};

} // namespace

TEST_P (Neighbours, EndWithHardlyAnyPenetration)
{
  CoSectionOptions options = optionsFor (neighbour_voxel_m);
  const SceneResult result = complete (touchingBoxes (GetParam ()), options);
  options.use_intersection = false;
  const SceneResult without = complete (touchingBoxes (GetParam ()), options);
  EXPECT_GT (deepestPenetration (without), 2.0);
  EXPECT_LE (deepestPenetration (result), about_a_voxel);
  for (const ObjectResult& object : result.objects)
  {
    EXPECT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
  }
}

INSTANTIATE_TEST_SUITE_P (DataOverlap, Neighbours, testing::Values (0, 1));

TEST (NeighboursOrder, DoesNotMatter)
{
  const RenderedView seen = touchingBoxes (1);
  RenderedView renamed = seen;
  std::swap (renamed.points[1], renamed.points[2]);
  const SceneResult a = complete (seen, optionsFor (neighbour_voxel_m));
  const SceneResult b = complete (renamed, optionsFor (neighbour_voxel_m));
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_EQ (a.objects[i].mesh.vertices, b.objects[1 - i].mesh.vertices);
    EXPECT_EQ (a.objects[i].mesh.triangles, b.objects[1 - i].mesh.triangles);
  }
}

/** \brief What one object hides of the other belongs to one of them at most. */
TEST (NeighboursReport, TheirPenetration)
{
  const SceneResult result = complete (touchingBoxes (1), optionsFor (neighbour_voxel_m));
  const double measured = deepestPenetration (result);
  const double reported =
      std::max (result.objects[0].penetration_m, result.objects[1].penetration_m) / neighbour_voxel_m;
  EXPECT_NEAR (reported, measured, 0.75);
}
