// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Automatic voxel sizes.

#include "completion/scenes/surrounding_views.h"

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A ring of 13 cm, 3 cm thick, on a table, as a camera with pixels of 2 mm sees it from a metre away. */
class RingFromFarAway : public testing::Test
{
protected:
  static constexpr double ring = 0.05;
  static constexpr double tube = 0.015;
  static constexpr double truth_m3 = 2.0 * M_PI * M_PI * ring * tube * tube;

  RingFromFarAway ()
  {
    scene_.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
    scene_.add (1, placed (torus (ring, tube), Eigen::Vector3d (0.0, 0.0, tube)));
    const PinholeCamera camera{320, 240, 520.0, 520.0, 159.5, 119.5};
    seen_ = scene_.render (camera, lookAt ({0.3, -0.8, 0.5}, {0.0, 0.0, 0.02}));
  }

  SceneResult all (const CoSectionOptions& options, int rings) const
  {
    CoSection task (options);
    task.addView (seen_.view);
    task.setBackground (seen_.points.at (0));
    for (int id = 1; id <= rings; ++id) // all at one place; their overlap does not matter here
      task.addObject ({id, seen_.points.at (1), {}});
    return task.reconstruct ();
  }

  ObjectResult completed (const CoSectionOptions& options) const { return all (options, 1).objects.at (0); }

  AnalyticScene scene_;
  RenderedView seen_;
};

} // namespace

TEST_F (RingFromFarAway, IsNoThickerThanItIs)
{
  const ObjectResult object = completed (CoSectionOptions ());
  ASSERT_EQ (object.error, "");
  EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
  EXPECT_LT (object.signed_distance->grid.voxel_size_m, 0.004); // two pixels; voxels of three points have 5 mm
  EXPECT_NEAR (computeMassProperties (object.mesh).volume_m3 / truth_m3, 1.0, 0.1);
  EXPECT_LT (meanError (object.mesh, scene_.shape (1)), 0.001);
}

TEST_F (RingFromFarAway, IsTheSameFromPointsThatAreGivenTwice)
{
  const ObjectResult once = completed (CoSectionOptions ());
  CoSection task;
  task.addView (seen_.view);
  task.setBackground (seen_.points.at (0));
  task.addObject ({1, seen_.points.at (1), {}});
  std::vector<OrientedPoint> nearly_same = seen_.points.at (1);
  for (OrientedPoint& point : nearly_same)
    point.position.x () += 1e-6f;
  task.addPoints (1, nearly_same);
  const SceneResult result = task.reconstruct ();
  const ObjectResult& twice = result.objects.at (0);
  EXPECT_NEAR (twice.signed_distance->grid.voxel_size_m, once.signed_distance->grid.voxel_size_m, 1e-4);
  EXPECT_NEAR (computeMassProperties (twice.mesh).volume_m3, computeMassProperties (once.mesh).volume_m3,
               0.02 * truth_m3);
  ASSERT_EQ (result.warnings.size (), 1u);
  EXPECT_EQ (result.warnings[0], "object 1: 50 % of its points repeat others, and are left out");
}

TEST_F (RingFromFarAway, TakesLargerVoxelsWhereMemoryAsksForThem)
{
  CoSectionOptions options;
  const ObjectResult fine = completed (options);
  ASSERT_EQ (fine.error, "");
  options.max_memory_bytes = 80 * fine.signed_distance->grid.size ();
  const ObjectResult coarse = completed (options);
  ASSERT_EQ (coarse.error, "");
  EXPECT_TRUE (computeTopology (coarse.mesh).closed_manifold);
  EXPECT_GT (coarse.signed_distance->grid.voxel_size_m, 1.4 * fine.signed_distance->grid.voxel_size_m);
  options.voxel_size_m = fine.signed_distance->grid.voxel_size_m;
  EXPECT_NE (completed (options).error, ""); // a given voxel size is not changed
}

TEST_F (RingFromFarAway, TakesLargerVoxelsAsAllMustFit)
{
  CoSectionOptions options;
  options.max_memory_bytes = 200 * completed (options).signed_distance->grid.size (); // enough for two fine ones
  for (const ObjectResult& object : all (options, 4).objects)
    EXPECT_EQ (object.error, "") << object.id;
}

// Noise larger than the spacing of the points, which voxels with three points average.
TEST_F (RingFromFarAway, HasLargerVoxelsWherePointsScatter)
{
  const double exact_m = completed (CoSectionOptions ()).signed_distance->grid.voxel_size_m;
  std::mt19937 random (1);
  std::normal_distribution<float> noise (0.0f, 0.005f);
  for (OrientedPoint& p : seen_.points.at (1))
    p.position += noise (random) * p.normal;
  EXPECT_GT (completed (CoSectionOptions ()).signed_distance->grid.voxel_size_m, 1.3 * exact_m);
}

/** \brief 64 along it would be fewer than three across. */
TEST (VoxelSize, OfWhatIsThinIsFiner)
{
  constexpr double half_length = 0.1, half_width = 0.004;
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, placed (box ({half_length, half_width, half_width}), Eigen::Vector3d (0.0, 0.0, half_width)));
  const PinholeCamera camera{320, 240, 300.0, 300.0, 159.5, 119.5};
  const RenderedView seen = scene.render (camera, lookAt ({0.1, -0.3, 0.2}, {0.0, 0.0, 0.0}));
  CoSection task;
  task.addView (seen.view);
  task.setBackground (seen.points.at (0));
  task.addObject ({1, seen.points.at (1), {}});
  const ObjectResult bar = task.reconstruct ().objects.at (0);
  EXPECT_LT (bar.signed_distance->grid.voxel_size_m, 0.8 * 2.0 * half_length / 64.0);
  EXPECT_NEAR (computeMassProperties (bar.mesh).volume_m3 / (8.0 * half_length * half_width * half_width), 1.0,
               0.2); // 1.33 with 64
}
