// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The hull of an object: all space that may belong to it, as no view saw it free.

#include "completion/scenes/surrounding_views.h"

#include <pcl/cosection/volume/mesh_distance.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double hull_voxel_m = 0.004;
constexpr int most_merged = 5;

CoSectionOptions
hullOptions ()
{
  CoSectionOptions options = optionsFor (hull_voxel_m);
  options.compute_hull = true;
  return options;
}

double
litres (const TriangleMesh& mesh)
{
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  return 1e3 * computeMassProperties (mesh).volume_m3;
}

Eigen::AlignedBox3d
boxOfMesh (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
  return box;
}

TriangleMesh
truthOf (const AnalyticScene& scene)
{
  return extractIsoSurface (sampleField (scene.shape (1), 0.15, 0.004));
}

/** \brief A view of tableScene () with its points. */
CoSection
taskOf (const RenderedView& seen, const CoSectionOptions& options)
{
  CoSection task (options);
  task.addView (seen.view);
  task.setBackground (seen.points.at (0));
  task.addObject ({1, seen.points.at (1), {}});
  return task;
}

class ObjectHulls : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (ObjectHulls, ShrinkAsViewsAreMerged)
{
  const AnalyticScene scene = tableScene (GetParam ());
  const TriangleMesh truth = truthOf (scene);
  for (const bool intersection : {false, true})
  {
    CoSectionOptions options = hullOptions ();
    options.use_intersection = intersection;
    std::vector<int> sensors;
    double first = 0.0, before = std::numeric_limits<double>::infinity ();
    for (int n = 0; n < most_merged; ++n)
    {
      sensors.push_back (n);
      const ObjectResult object = completeFrom (scene, sensors, options);
      ASSERT_EQ (object.error, "");
      const double now = litres (object.hull);
      std::printf ("%s, %d views: %.3f litres, truly %.3f\n", nameOf (GetParam ()).c_str (), n + 1, now,
                   litres (truth));
      EXPECT_LE (now, 1.005 * before) << n + 1 << " views";
      const SignedDistanceField field = sampleField (scene.shape (1), 0.2, hull_voxel_m);
      const SignedDistanceField hull = sampleSignedDistance (object.hull, field.grid, 0.02);
      for (const Eigen::Vector3f& v : truth.vertices)
        ASSERT_LE (hull.sample (v.cast<double> ()).value_or (1.0f), 1.5 * hull_voxel_m)
            << v.transpose () << ", " << n + 1 << " views";
      before = now;
      first = n == 0 ? now : first;
    }
    EXPECT_LT (before, 0.85 * first);
  }
}

TEST_P (ObjectHulls, LeaveTheTable)
{
  const AnalyticScene scene = tableScene (GetParam ());
  const ObjectResult object = completeFrom (scene, {0, 1, 2, 3, 4}, hullOptions ());
  const Eigen::AlignedBox3d hull = boxOfMesh (object.hull), truth = boxOfMesh (truthOf (scene));
  constexpr double layer_m = 4.0 * hull_voxel_m; // the margin of free space, and a voxel
  const Eigen::Vector3d beyond = (hull.max () - truth.max ()).cwiseMax (truth.min () - hull.min ());
  EXPECT_LT (beyond.head<2> ().maxCoeff (), 1.25 * layer_m + 3.0 * hull_voxel_m);
  EXPECT_GT (hull.min ().z (), -1.5 * hull_voxel_m);
  EXPECT_LT (hull.max ().z () - truth.max ().z (), layer_m);
}

INSTANTIATE_TEST_SUITE_P (Shapes, ObjectHulls, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (ObjectHull, FollowsNoRaysOfSinglePixels)
{
  const AnalyticScene scene = tableScene (Shape::Box);
  RenderedView seen = scene.render (tableCamera (), fromAbove ());
  const ObjectResult all = taskOf (seen, hullOptions ()).reconstruct ().objects.at (0);
  std::mt19937 random (1);
  for (float& z : seen.view.depth)
    if (random () % 50 == 0)
      z = std::numeric_limits<float>::quiet_NaN ();
  const ObjectResult some = taskOf (seen, hullOptions ()).reconstruct ().objects.at (0);
  EXPECT_NEAR (litres (some.hull), litres (all.hull), 0.08 * litres (all.hull));
  EXPECT_TRUE (boxOfMesh (some.hull).sizes ().isApprox (boxOfMesh (all.hull).sizes (), 0.1));
}

TEST (ObjectHull, WhatIsPutLowerIsNotCutByTheTable)
{
  RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  const ObjectResult rests = taskOf (seen, hullOptions ()).reconstruct ().objects.at (0);
  CoSection task (hullOptions ());
  task.addView (seen.view);
  const Eigen::Isometry3d lower (Eigen::Translation3d (0.0, 0.0, -0.5));
  seen.view.T_world_sensor = lower * seen.view.T_world_sensor; // the same view of the object, on the floor
  task.addView (seen.view);
  task.setBackground (seen.points.at (0));
  task.addObject ({1, seen.points.at (1), {Eigen::Isometry3d::Identity (), lower}});
  const ObjectResult moves = task.reconstruct ().objects.at (0);
  ASSERT_EQ (moves.error, "");
  EXPECT_NEAR (litres (moves.hull), litres (rests.hull), 0.1 * litres (rests.hull));
  EXPECT_NEAR (litres (moves.mesh), litres (rests.mesh), 0.05 * litres (rests.mesh));
}

TEST (ObjectHull, IsTheVolumeWhereNothingIsKnown)
{
  const RenderedView seen = tableScene (Shape::Sphere).render (tableCamera (), fromAbove ());
  CoSection task (hullOptions ());
  task.addObject ({1, seen.points.at (1), {}});
  const ObjectResult object = task.reconstruct ().objects.at (0);
  ASSERT_EQ (object.error, "");
  const VoxelGrid& grid = object.signed_distance->grid;
  EXPECT_NEAR (1e-3 * litres (object.hull) / (grid.dims.cast<double> () * grid.voxel_size_m).prod (), 1.0,
               0.35); // but for its border
}

TEST (ObjectHull, StaysInAVolumeThatIsGiven)
{
  const RenderedView seen = tableScene (Shape::Sphere).render (tableCamera (), fromTheFront ());
  CoSectionOptions options = hullOptions ();
  options.padding = 0.1;
  const ObjectResult object = taskOf (seen, options).reconstruct ().objects.at (0);
  ASSERT_EQ (object.error, "");
  const VoxelGrid& grid = object.signed_distance->grid;
  EXPECT_TRUE (
      Eigen::AlignedBox3d (grid.origin_m, grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1))
          .contains (boxOfMesh (object.hull)));
}

TEST (ObjectHull, TakesNoMoreMemoryThanIsAllowed)
{
  const RenderedView seen = tableScene (Shape::Sphere).render (tableCamera (), fromAbove ());
  CoSectionOptions options = hullOptions ();
  const ObjectResult free = taskOf (seen, options).reconstruct ().objects.at (0);
  ObjectResult least;
  for (options.max_memory_bytes = 1 << 20; options.max_memory_bytes < std::size_t (1) << 34;
       options.max_memory_bytes += options.max_memory_bytes / 16)
    if (least = taskOf (seen, options).reconstruct ().objects.at (0); least.error.empty ())
      break;
  ASSERT_EQ (least.error, "");
  EXPECT_LT (litres (least.hull), litres (free.hull));
  EXPECT_NEAR (litres (least.mesh), litres (free.mesh), 0.01 * litres (free.mesh));
}
