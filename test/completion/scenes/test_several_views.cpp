// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Completion from several views of one scene.

#include "surrounding_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int most_views = 5;

double
volume (const TriangleMesh& mesh)
{
  return computeMassProperties (mesh).volume_m3;
}

class SeveralViews : public testing::TestWithParam<Shape>
{
protected:
  const AnalyticScene scene_ = tableScene (GetParam ());
};

} // namespace

TEST_P (SeveralViews, AreTogetherAtLeastAsAccurateAsEachAlone)
{
  double best_alone = std::numeric_limits<double>::infinity ();
  std::vector<int> sensors;
  for (int n = 0; n < most_views; ++n)
  {
    const ObjectResult alone = completeFrom (scene_, {n}, optionsFor (voxel_m));
    ASSERT_EQ (alone.error, "");
    const double alone_m = meanError (alone.mesh, scene_.shape (1));
    best_alone = std::min (best_alone, alone_m);
    sensors.push_back (n);
    const ObjectResult together = completeFrom (scene_, sensors, optionsFor (voxel_m));
    ASSERT_EQ (together.error, "");
    EXPECT_TRUE (computeTopology (together.mesh).closed_manifold);
    const double together_m = meanError (together.mesh, scene_.shape (1));
    std::printf ("%s: mean error of view %d alone %.2f mm, of views 1 to %d %.2f mm\n", nameOf (GetParam ()).c_str (),
                 n + 1, 1e3 * alone_m, n + 1, 1e3 * together_m);
    EXPECT_TRUE (n == 0 || together_m <= best_alone) << n + 1 << " views";
  }
}

/** \brief The hull of constant points with an increasing number of views. */
TEST_P (SeveralViews, ShrinkTheHull)
{
  CoSectionOptions options = optionsFor (voxel_m);
  options.use_intersection = false;
  options.use_extent_prior = false; // its bounds grow with the observed surface, so shapes may grow
  options.compute_hull = true;
  options.padding = 0.5; // the same volume for all
  const RenderedView first = scene_.render (tableCamera (), around (0));
  CoSection task (options);
  task.addObject ({1, first.points.at (1), {}});
  double estimate_before = std::numeric_limits<double>::infinity ();
  double hull_before = std::numeric_limits<double>::infinity ();
  for (int n = 0; n < most_views; ++n)
  {
    task.addView (scene_.render (tableCamera (), around (n)).view);
    const ObjectResult object = task.reconstruct ().objects.at (0);
    ASSERT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.hull).closed_manifold);
    const double estimate = volume (object.mesh), hull = volume (object.hull);
    std::printf ("%s, %d views: estimate %.3f litres, hull %.3f litres\n", nameOf (GetParam ()).c_str (), n + 1,
                 1e3 * estimate, 1e3 * hull);
    EXPECT_GT (hull, estimate);
    EXPECT_LE (estimate, 1.002 * estimate_before) << n + 1 << " views";
    EXPECT_LT (hull, hull_before) << n + 1 << " views";
    estimate_before = estimate;
    hull_before = hull;
  }
  double truth = volume (extractIsoSurface (sampleField (scene_.shape (1), 0.15, 0.003)));
  EXPECT_GT (hull_before, 0.95 * truth); // nothing of the body was cut off
}

/** \brief Near a table views cannot look through the space beside a thing by more than the margin of free space. That
 * they see the table there says as much. */
TEST (SeveralViewsOfATable, WhatLiesThereDoesNotSpread)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  const Distance rod = placed (box ({0.06, 0.006, 0.003}), Eigen::Vector3d (0.0, 0.0, 0.013)); // like a spoon's handle
  scene.add (1, rod);
  const ObjectResult object = completeFrom (scene, {0, 1, 2}, optionsFor (voxel_m));
  ASSERT_EQ (object.error, "");
  double beside_m = 0.0;
  for (const Eigen::Vector3f& vertex : object.mesh.vertices)
    beside_m = std::max (beside_m, std::abs (vertex.y ()) - 0.006);
  std::printf ("widest %.1f mm beside the rod\n", 1e3 * beside_m);
  EXPECT_LT (beside_m, voxel_m);
}

TEST (SeveralViewsOfATable, SilhouettesDoNotBreakThroughAThinWall)
{
  constexpr double wall_m = 0.004;
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, cup (0.04, 0.08, wall_m));
  const ObjectResult object = completeFrom (scene, {0, 1, 2}, optionsFor (0.0));
  ASSERT_EQ (object.error, "");
  EXPECT_EQ (computeTopology (object.mesh).euler, 2);
}

INSTANTIATE_TEST_SUITE_P (Shapes, SeveralViews, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
