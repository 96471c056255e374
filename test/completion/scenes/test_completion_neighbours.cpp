// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "neighbour_scene.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class Neighbours : public testing::TestWithParam<int> // voxels by which the data of one is pushed into the other
{};

} // namespace

TEST_P (Neighbours, EndWithHardlyAnyPenetration)
{
  CoSectionOptions options = optionsFor (neighbour_voxel_m);
  const SceneResult result = complete (touchingBoxes (GetParam ()), options);
  options.priors = Priors::named ("extent"); // others tell where they end
  const SceneResult with_it = complete (touchingBoxes (GetParam ()), options);
  options.use_intersection = false;
  const SceneResult without = complete (touchingBoxes (GetParam ()), options);
  EXPECT_GT (deepestPenetration (without), 2.0);
  EXPECT_LE (deepestPenetration (with_it), about_a_voxel);
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

TEST (NeighboursReport, TheirPenetration)
{
  const SceneResult result = complete (touchingBoxes (1), optionsFor (neighbour_voxel_m));
  for (int i = 0; i < 2; ++i)
  {
    double measured = 0.0; // in the other and in the table
    for (const Eigen::Vector3f& v : result.objects[i].mesh.vertices)
    {
      measured = std::max (measured, static_cast<double> (-v.z ()));
      if (const auto u = result.objects[1 - i].signed_distance->sampleSupported (v.cast<double> ()))
        measured = std::max (measured, static_cast<double> (-*u));
    }
    EXPECT_NEAR (result.objects[i].penetration_m, measured, 0.2 * neighbour_voxel_m);
  }
}

/** \brief The hidden contact of two objects is divided between them without a gap, near its visible part. */
TEST (NeighboursContact, LeavesNoGap)
{
  const SceneResult result = complete (touchingBoxes (0), optionsFor (neighbour_voxel_m));
  for (double x = -0.03; x <= 0.03; x += 0.005)
    for (double z = 0.05; z <= 0.07; z += 0.005)
    {
      double gap = 0.0;
      for (const ObjectResult& object : result.objects)
        gap += object.signed_distance->sample (Eigen::Vector3d (x, 0.0, z)).value ();
      EXPECT_LE (std::abs (gap), 1.0 * neighbour_voxel_m) << "at x = " << x << ", z = " << z;
    }
}
