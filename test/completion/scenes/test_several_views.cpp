// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Completion from several views of one scene.

#include "surrounding_views.h"

#include <gtest/gtest.h>

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
 * they see the table there says as much; between the points of a thinned cloud it is not known. */
TEST (ViewsOfATable, KeepAThinThingFromSpreadingOnIt)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  const Distance plate = placed (box ({0.06, 0.02, 0.003}), // tilted, like a spoon
                                 Eigen::Translation3d (0.0, 0.0, 0.02) *
                                     motion (0.2, Eigen::Vector3d::UnitY (), Eigen::Vector3d::Zero ()));
  scene.add (1, plate);
  for (const int views : {1, 2, 3})
  {
    const auto errorWith = [&] (std::size_t every) {
      CoSection task (optionsFor (voxel_m));
      std::vector<OrientedPoint> object, background;
      for (int n = 0; n < views; ++n)
      {
        const RenderedView seen = scene.render (tableCamera (), around (n));
        task.addView (seen.view);
        object.insert (object.end (), seen.points.at (1).begin (), seen.points.at (1).end ());
        for (std::size_t p = 0; p < seen.points.at (0).size (); p += every)
          background.push_back (seen.points.at (0)[p]);
      }
      task.setBackground (background);
      task.addObject ({1, object, {}});
      return meanError (task.reconstruct ().objects.at (0).mesh, plate);
    };
    const double all_m = errorWith (1), thinned_m = errorWith (3);
    std::printf ("%d views: mean error %.2f mm, with a thinned table %.2f mm\n", views, 1e3 * all_m, 1e3 * thinned_m);
    EXPECT_LT (all_m, 0.9 * thinned_m) << views;
  }
}

INSTANTIATE_TEST_SUITE_P (Shapes, SeveralViews, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
