// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Warnings about views that contradict each other.

#include "completion/scenes/surrounding_views.h"
#include "priors/moved_points.h"

#include "pcl_cosection/view/visibility/free_space_votes.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double always_less = 0.02; // share of the points that noise and edges may contradict
constexpr double warned_of = 0.1;

bool
isSaid (const SceneResult& result)
{
  return std::any_of (result.warnings.begin (), result.warnings.end (),
                      [] (const std::string& warning) { return warning.find ("looks through") != std::string::npos; });
}

/** \brief The shape on its table from several sides; the pose of the second view is wrong by \a error. */
class AgreementOfViews : public testing::TestWithParam<Shape>
{
protected:
  SceneResult completeWith (const Eigen::Isometry3d& error, int views, CoSectionOptions options = optionsFor (voxel_m))
  {
    CoSection task (options);
    std::vector<OrientedPoint> object, background;
    for (int n = 0; n < views; ++n)
    {
      RenderedView seen = scene_.render (tableCamera (), around (n));
      const Eigen::Isometry3d T = n == 1 ? error : Eigen::Isometry3d::Identity ();
      seen.view.T_world_sensor = T * seen.view.T_world_sensor;
      task.addView (seen.view);
      for (auto& [label, points] : std::map<int, std::vector<OrientedPoint>*>{{1, &object}, {0, &background}})
      {
        const std::vector<OrientedPoint> there = moved (seen.points[label], T);
        points->insert (points->end (), there.begin (), there.end ());
      }
    }
    task.setBackground (background);
    task.addObject ({1, object, {}});
    return task.reconstruct ();
  }

  const AnalyticScene scene_ = tableScene (GetParam ());
};

} // namespace

TEST_P (AgreementOfViews, RightPosesAgree)
{
  for (const int views : {1, 2, 5})
  {
    const SceneResult result = completeWith (Eigen::Isometry3d::Identity (), views);
    EXPECT_LT (result.objects.at (0).contradicted_share, always_less) << views;
    EXPECT_FALSE (isSaid (result)) << views;
  }
}

TEST_P (AgreementOfViews, AWrongPoseIsSaid)
{
  const Eigen::Isometry3d aside (Eigen::Translation3d (0.0, 0.0, 0.05));
  for (const int views : {2, 3})
  {
    const SceneResult result = completeWith (aside, views);
    EXPECT_GT (result.objects.at (0).contradicted_share, warned_of) << views;
    EXPECT_TRUE (isSaid (result)) << views;
  }
  CoSectionOptions options = optionsFor (voxel_m);
  options.use_hull = false; // without votes on free space
  EXPECT_FALSE (isSaid (completeWith (aside, 2, options)));
}

/** \brief The shape moves between two views with correct poses. */
TEST_P (AgreementOfViews, WhatMovesNeedsPoses)
{
  const Eigen::Isometry3d motion (Eigen::Translation3d (0.1, 0.06, 0.0));
  const auto is_said = [&] (bool with_poses) {
    CoSection task (optionsFor (voxel_m));
    std::vector<OrientedPoint> object;
    for (int n = 0; n < 2; ++n)
    {
      const Eigen::Isometry3d T = n == 1 ? motion : Eigen::Isometry3d::Identity ();
      RenderedView seen = scene_.render (tableCamera (),
                                         T.inverse () * around (n)); // as if the sensor had moved with the table
      seen.view.T_world_sensor = around (n);
      task.addView (seen.view);
      const std::vector<OrientedPoint> there = with_poses ? seen.points.at (1) : moved (seen.points.at (1), T);
      object.insert (object.end (), there.begin (), there.end ());
    }
    task.addObject ({1, object,
                     with_poses ? std::vector<Eigen::Isometry3d>{Eigen::Isometry3d::Identity (), motion}
                                : std::vector<Eigen::Isometry3d>{}});
    return isSaid (task.reconstruct ());
  };
  EXPECT_TRUE (is_said (false));
  EXPECT_FALSE (is_said (true));
}

INSTANTIATE_TEST_SUITE_P (Shapes, AgreementOfViews,
                          testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (AgreementOfViews, GroupsFarApartAreSaid)
{
  for (const double aside_m : {0.0, 0.05, 1.0})
  {
    const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), around (0));
    std::vector<OrientedPoint> points = seen.points.at (1);
    const std::vector<OrientedPoint> again = moved (points,
                                                    Eigen::Isometry3d (Eigen::Translation3d (aside_m, 0.0, 0.0)));
    points.insert (points.end (), again.begin (), again.end ());
    CoSection task (optionsFor (0.02));
    task.addObject ({1, points, {}});
    const SceneResult result = task.reconstruct ();
    const bool is_said = std::any_of (
        result.warnings.begin (), result.warnings.end (),
        [] (const std::string& warning) { return warning.find ("cm apart") != std::string::npos; });
    EXPECT_EQ (is_said, aside_m > 0.5) << aside_m;
  }
}

TEST (FreeSpaceVotes, OfOneViewMoreAreAdded)
{
  const AnalyticScene scene = tableScene (Shape::Box);
  std::vector<FreeSpaceView> views;
  std::vector<Eigen::Vector3f> points;
  for (int n = 0; n < 3; ++n)
  {
    RenderedView seen = scene.render (tableCamera (), around (n));
    for (const OrientedPoint& p : seen.points.at (1))
      points.push_back (p.position + Eigen::Vector3f (0.0f, 0.0f, n == 1 ? 0.03f : 0.0f));
    views.emplace_back (std::move (seen.view));
  }
  const std::vector<FreeSpaceVotes> together = voteOnPoints (points, views);
  std::vector<FreeSpaceVotes> added (points.size ());
  for (const FreeSpaceView& view : views)
    addVotes (points, view, view.view ().T_world_sensor, added);
  int free = 0;
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    free += together[p].free > 0;
    ASSERT_EQ (added[p].free, together[p].free);
    ASSERT_EQ (added[p].surface, together[p].surface);
  }
  EXPECT_GT (free, 100);
  added.pop_back ();
  EXPECT_THROW (addVotes (points, views[0], views[0].view ().T_world_sensor, added), InvalidArgument);
}
