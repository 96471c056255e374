// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The learned prior: what a network sees, and what becomes of its answer. The networks here know the answer.

#include "completion_scene.h"
#include "surrounding_views.h"

#include "pcl_cosection/priors/learned/completion_cube.h"
#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <pcl/cosection/surface/options.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A head, off the middle of a foot that reaches back: nothing seen from the front tells how far. */
Distance
guessedFigure ()
{
  const Distance foot = placed (box ({0.03, 0.06, 0.015}), Eigen::Vector3d (0.0, 0.02, 0.015));
  const Distance head = placed (box ({0.012, 0.02, 0.03}), Eigen::Vector3d (0.012, -0.01, 0.055));
  return [=] (const Eigen::Vector3d& p) { return std::min (foot (p), head (p)); };
}

/** \brief A vertical cylinder with an elliptic outline. \param[in] deep half of its extent away from the sensor */
Distance
oval (double wide, double deep)
{
  return placed (
      [=] (const Eigen::Vector3d& p) {
        const Eigen::Vector2d q (p.x () / wide, p.y () / deep);
        const double slope = std::max (1.0, 2.0 * Eigen::Vector2d (q.x () / wide, q.y () / deep).norm ());
        return std::max ((q.squaredNorm () - 1.0) / slope, std::abs (p.z ()) - 0.05);
      },
      Eigen::Vector3d (0.0, 0.0, 0.05));
}

bool
hasRoundProfile (const Distance& shape)
{
  const ProfiledShape profiled (seenFromTheFront (shape).points.at (1), table_plane);
  return profiled && !(profiled.wallThickness () > 0.0);
}

ObjectResult
completeWithNetwork (const Distance& shape, CompletionNetwork::ConstPtr network)
{
  const RenderedView view = seenFromTheFront (shape);
  CoSectionOptions options = optionsFor (0.004);
  options.completion_network = std::move (network);
  CoSection task (options);
  task.addView (view.view);
  task.setBackground (view.points.at (0));
  task.addObject ({1, view.points.at (1), {}});
  return task.reconstruct ().objects.at (0);
}

/** \brief The cube of a shape's view. */
CompletionCube
cubeOf (const RenderedView& view)
{
  const SensorViews views = {{&view.view, view.view.T_world_sensor}};
  return completionCube (view.points.at (1), views, table_plane).value ();
}

/** \brief Answers with a shape. */
class Oracle : public CompletionNetwork
{
public:
  /** \param[in] most_logit how sure it is */
  explicit Oracle (const Distance& answer, const Distance& asked, double most_logit = 10.0)
      : answer_ (answer)
      , most_logit_ (most_logit)
      , cube_ (cubeOf (seenFromTheFront (asked)))
  {}

  std::vector<float> complete (const std::vector<float>& observed) const override
  {
    EXPECT_EQ (observed.size (), channels * CompletionCube::voxels);
    // The input is given as it is, and mirrored: here that is known by what is seen.
    const bool is_mirrored = calls_++ % 2 == 1;
    std::vector<float> logits (CompletionCube::voxels);
    for (int k = 0; k < size; ++k)
      for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i)
          logits[CompletionCube::index (i, is_mirrored ? size - 1 - j : j, k)] = static_cast<float> (
              std::clamp (-answer_ (cube_.center (i, j, k)) / cube_.voxel_size_m / 0.4, -most_logit_, most_logit_));
    return logits;
  }

  int calls () const { return calls_; }

private:
  Distance answer_;
  double most_logit_;
  CompletionCube cube_;
  mutable int calls_ = 0;
};

} // namespace

TEST (LearnedPrior, TheCubeStandsOnTheTableBehindWhatIsSeen)
{
  const RenderedView view = seenFromTheFront (guessedFigure ());
  const CompletionCube cube = cubeOf (view);
  EXPECT_NEAR (cube.T_object_cube.translation ().z (), -CompletionCube::below_vox * cube.voxel_size_m, 1e-9);
  const Eigen::Vector3d x = cube.T_object_cube.linear ().col (0), z = cube.T_object_cube.linear ().col (2);
  EXPECT_NEAR (z.z (), 1.0, 1e-9);
  const Eigen::Vector3d to_object = -view.view.T_world_sensor.translation ();
  EXPECT_GT (x.dot (Eigen::Vector3d (to_object.x (), to_object.y (), 0.0).normalized ()), 0.9);
  std::size_t inside = 0;
  for (const OrientedPoint& point : view.points.at (1))
  {
    const Eigen::Vector3d p = cube.T_object_cube.inverse () * point.position.cast<double> () / cube.voxel_size_m;
    inside += (p.array () > 0.0).all () && (p.array () < CompletionCube::size).all ();
  }
  EXPECT_GT (inside, 0.95 * static_cast<double> (view.points.at (1).size ()));
  EXPECT_FALSE (completionCube ({}, {}, table_plane));
  EXPECT_FALSE (completionCube ({{Eigen::Vector3f::Zero (), Eigen::Vector3f::UnitZ ()}},
                                {{&view.view, view.view.T_world_sensor}}, table_plane));
}

TEST (LearnedPrior, WhatAViewTellsOfTheVoxels)
{
  const RenderedView view = seenFromTheFront (guessedFigure ());
  const CompletionCube cube = cubeOf (view);
  const CompletionInputs inputs = completionInputs (cube, view.points.at (1), {{&view.view, view.view.T_world_sensor}});
  std::size_t matter = 0, wrong = 0, free = 0;
  for (int k = CompletionCube::below_vox; k < CompletionCube::size; ++k)
    for (int j = 0; j < CompletionCube::size; ++j)
      for (int i = 0; i < CompletionCube::size; ++i)
      {
        const std::size_t n = CompletionCube::index (i, j, k);
        const double distance = guessedFigure () (cube.center (i, j, k));
        EXPECT_LE (inputs.is_free[n] + inputs.is_behind[n] + inputs.is_unknown[n], 1);
        matter += distance < -0.5 * cube.voxel_size_m;
        free += inputs.is_free[n];
        wrong += distance < -0.5 * cube.voxel_size_m && inputs.is_free[n];
      }
  EXPECT_GT (matter, 500u);
  EXPECT_GT (free, 2000u);
  EXPECT_EQ (wrong, 0u); // no view looks through matter
}

TEST (LearnedPrior, AnswersThatTheViewConfirmsAreExpected)
{
  const auto oracle = std::make_shared<Oracle> (guessedFigure (), guessedFigure ());
  const ObjectResult with = completeWithNetwork (guessedFigure (), oracle),
                     without = completeWithNetwork (guessedFigure (), nullptr);
  ASSERT_EQ (with.error, "");
  EXPECT_EQ (oracle->calls (), 2); // once, and once mirrored
  ASSERT_TRUE (with.learned);
  EXPECT_TRUE (with.learned->used);
  EXPECT_FALSE (without.learned);
  EXPECT_LT (meanError (with.mesh, guessedFigure ()), 0.0025);
  EXPECT_LT (meanError (with.mesh, guessedFigure ()), 0.7 * meanError (without.mesh, guessedFigure ()));
}

TEST (LearnedPrior, AnswersThatTheViewContradictsChangeNothing)
{
  const Distance wrong = placed (box ({0.02, 0.02, 0.06}), Eigen::Vector3d (0.06, -0.06, 0.06));
  const ObjectResult with = completeWithNetwork (guessedFigure (), std::make_shared<Oracle> (wrong, guessedFigure ()));
  const ObjectResult without = completeWithNetwork (guessedFigure (), nullptr);
  ASSERT_TRUE (with.learned);
  EXPECT_FALSE (with.learned->used);
  EXPECT_EQ (with.mesh.vertices, without.mesh.vertices);
  EXPECT_EQ (with.mesh.triangles, without.mesh.triangles);
}

TEST (LearnedPrior, AnUnsureAnswerChangesLittle)
{
  const double without = meanError (completeWithNetwork (guessedFigure (), nullptr).mesh, guessedFigure ());
  const auto gainWith = [&] (double most_logit) {
    const ObjectResult result = completeWithNetwork (
        guessedFigure (), std::make_shared<Oracle> (guessedFigure (), guessedFigure (), most_logit));
    EXPECT_TRUE (result.learned && result.learned->used);
    return without - meanError (result.mesh, guessedFigure ());
  };
  EXPECT_LT (std::abs (gainWith (0.5)), 0.5 * gainWith (10.0));
}

TEST (LearnedPrior, AnswersOfWrongSizeAreErrors)
{
  class Short : public CompletionNetwork
  {
    std::vector<float> complete (const std::vector<float>&) const override { return {1.0f}; }
  };
  const ObjectResult result = completeWithNetwork (guessedFigure (), std::make_shared<Short> ());
  EXPECT_NE (result.error.find ("32768"), std::string::npos) << result.error;
}

/** \brief Of a thing that was cut out, the rays beside it have no reading. */
TEST (LearnedPrior, RaysBesideWhatWasCutOutAreFree)
{
  class Listener : public CompletionNetwork
  {
  public:
    std::vector<float> complete (const std::vector<float>& observed) const override
    {
      const auto free = observed.begin () + CompletionCube::voxels;
      free_ = static_cast<std::size_t> (std::count (free, free + CompletionCube::voxels, 1.0f));
      return std::vector<float> (CompletionCube::voxels, -1.0f);
    }
    mutable std::size_t free_ = 0;
  };
  const RenderedView whole = seenFromTheFront (guessedFigure ());
  DepthView own = whole.view;
  std::fill (own.depth.begin (), own.depth.end (), std::numeric_limits<float>::quiet_NaN ());
  for (const OrientedPoint& point : whole.points.at (1))
  {
    const Eigen::Vector3d p = own.T_world_sensor.inverse () * point.position.cast<double> ();
    const Eigen::Array2i pixel = own.camera.project (p).array ().round ().cast<int> ();
    own.depth[static_cast<std::size_t> (pixel.y ()) * own.camera.width + pixel.x ()] = static_cast<float> (p.z ());
  }
  const auto freeVoxels = [&] (const DepthView& view, const std::vector<OrientedPoint>& background) {
    const auto network = std::make_shared<Listener> ();
    CoSectionOptions options = optionsFor (0.004);
    options.completion_network = network;
    CoSection task (options);
    task.addView (view);
    task.setBackground (background);
    task.addSupportPlane (table_plane);
    task.addObject ({1, whole.points.at (1), {}});
    task.reconstruct ();
    return network->free_;
  };
  const std::size_t in_scene = freeVoxels (whole.view, whole.points.at (0));
  EXPECT_GT (in_scene, 2000u);
  EXPECT_GT (freeVoxels (own, {}), in_scene / 2);
  EXPECT_LT (freeVoxels (own, whole.points.at (0)), in_scene / 2); // missing readings tell nothing where others are
}

TEST (LearnedPrior, NoAnswerChangesNothing)
{
  const Distance nothing = [] (const Eigen::Vector3d&) { return 1.0; };
  const ObjectResult with = completeWithNetwork (guessedFigure (),
                                                 std::make_shared<Oracle> (nothing, guessedFigure ()));
  EXPECT_FALSE (with.learned);
  EXPECT_EQ (with.mesh.vertices, completeWithNetwork (guessedFigure (), nullptr).mesh.vertices);
}

TEST (LearnedPrior, SurfacesOfRevolutionAreMoreExact)
{
  const Distance can = oval (0.03, 0.03);
  ASSERT_TRUE (hasRoundProfile (can));
  const Distance other = [can] (const Eigen::Vector3d& p) { return can (p) - (p.y () > 0.0 ? 0.006 : 0.0); };
  const ObjectResult with = completeWithNetwork (can, std::make_shared<Oracle> (other, can));
  EXPECT_FALSE (with.learned);
  EXPECT_LT (meanError (with.mesh, can), 0.001);
}

/** \brief A round profile fits, but its copies lie where the view looked through. */
TEST (LearnedPrior, WhatOnlySeemsRoundIsCompleted)
{
  const Distance shampoo = oval (0.045, 0.02);
  ASSERT_TRUE (hasRoundProfile (shampoo));
  const ObjectResult with = completeWithNetwork (shampoo, std::make_shared<Oracle> (shampoo, shampoo));
  ASSERT_TRUE (with.learned);
  EXPECT_TRUE (with.learned->used);
  EXPECT_LT (meanError (with.mesh, shampoo), 0.003);
  EXPECT_LT (meanError (with.mesh, shampoo), 0.7 * meanError (completeWithNetwork (shampoo, nullptr).mesh, shampoo));
}
