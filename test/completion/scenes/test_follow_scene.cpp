// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// CoSection::update () on a growing scene gives the result of a fresh run on all of it.

#include "surrounding_views.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <map>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Poses = std::map<int, Eigen::Isometry3d>;

/** \brief Add a rendered view to a scene; points of objects with a pose are in the objects' frames. */
void
show (const AnalyticScene& scene, int sensor, const Poses& T_world_object, CoSection& task, double farthest_x = 1.0)
{
  const RenderedView seen = scene.render (tableCamera (), around (sensor));
  task.addView (seen.view, T_world_object);
  for (const auto& [label, all] : seen.points)
  {
    std::vector<OrientedPoint> points;
    const auto pose = T_world_object.find (label);
    const Eigen::Isometry3d T = pose == T_world_object.end () ? Eigen::Isometry3d::Identity ()
                                                              : pose->second.inverse ();
    for (OrientedPoint p : all)
    {
      if (label != 0 && p.position.x () > farthest_x)
        continue;
      p.position = (T * p.position.cast<double> ()).cast<float> ();
      p.normal = (T.linear () * p.normal.cast<double> ()).cast<float> ();
      points.push_back (p);
    }
    if (label == 0)
      task.addBackground (points);
    else if (label > 0)
      task.addPoints (label, points);
  }
}

/** \brief Compare each object of two results. */
void
expectSameObjects (const SceneResult& followed, const SceneResult& fresh)
{
  ASSERT_EQ (followed.objects.size (), fresh.objects.size ());
  for (std::size_t o = 0; o < fresh.objects.size (); ++o)
  {
    ASSERT_EQ (followed.objects[o].error, "");
    ASSERT_EQ (fresh.objects[o].error, "");
    const double rms = differenceNearSurface (*fresh.objects[o].signed_distance, *followed.objects[o].signed_distance)
                           .rms_vox;
    std::printf ("object %d: root mean square difference %.3f voxels near the surface\n", fresh.objects[o].id, rms);
    EXPECT_LT (rms, 0.1);
  }
}

class FollowScene : public testing::TestWithParam<Shape>
{
protected:
  static CoSectionOptions options ()
  {
    CoSectionOptions options = optionsFor (voxel_m);
    options.whole_background = true;
    return options;
  }

  const AnalyticScene scene_ = tableScene (GetParam ());
};

} // namespace

TEST_P (FollowScene, UpdatesGiveWhatAFreshRunGives)
{
  CoSection task (options ());
  for (int sensor = 0; sensor < 4; ++sensor)
  {
    show (scene_, sensor, {}, task);
    const SceneResult now = task.update (UpdateOutput::Fields);
    ASSERT_EQ (now.objects.size (), 1u);
    EXPECT_EQ (now.objects[0].error, "");
    EXPECT_TRUE (now.objects[0].mesh.empty ());
  }
  const SceneResult followed = task.update ();
  expectSameObjects (followed, task.reconstruct ());
  EXPECT_TRUE (computeTopology (followed.objects[0].mesh).closed_manifold);
  ASSERT_EQ (followed.background_pieces.size (), 1u);
  const SceneResult fresh = task.reconstruct ();
  EXPECT_LT (differenceNearSurface (*fresh.background_pieces.at (0).signed_distance,
                                    *followed.background_pieces[0].signed_distance)
                 .rms_vox,
             0.1);
}

/** \brief With automatic voxel sizes: those of a vessel are finer, and its Gaussians wider while points are few. */
TEST (FollowScene, VoxelsAndGaussiansFollowThePoints)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, cup (0.045, 0.09, 0.005));
  CoSection task (optionsFor (0.0));
  for (int sensor = 0; sensor < 4; ++sensor)
  {
    show (scene, sensor, {}, task);
    const SceneResult followed = task.update ();
    const SceneResult fresh = task.reconstruct ();
    expectSameObjects (followed, fresh);
    // An update keeps its voxels until the points ask for others by more than a fifth.
    const double kept = followed.objects.at (0).signed_distance->grid.voxel_size_m;
    const double wanted = fresh.objects.at (0).signed_distance->grid.voxel_size_m;
    EXPECT_LT (std::max (kept / wanted, wanted / kept), 1.2);
  }
}

/** \brief The first view has only the left part of the object. */
TEST_P (FollowScene, AnObjectOutgrowsItsVolume)
{
  CoSection task (options ());
  show (scene_, 0, {}, task, -0.01);
  const VoxelGrid before = task.update (UpdateOutput::Fields).objects.at (0).signed_distance->grid;
  show (scene_, 1, {}, task);
  show (scene_, 2, {}, task);
  const SceneResult followed = task.update ();
  const VoxelGrid after = followed.objects.at (0).signed_distance->grid;
  EXPECT_GT (after.center (after.dims.x () - 1, 0, 0).x (), before.center (before.dims.x () - 1, 0, 0).x ());
  const Eigen::Vector3d shift = (after.origin_m - before.origin_m) / voxel_m;
  EXPECT_LT ((shift.array () - shift.array ().round ()).abs ().maxCoeff (), 1e-6) << "another lattice";
  expectSameObjects (followed, task.reconstruct ());
}

TEST_P (FollowScene, AnObjectThatIsGivenUpLeavesNothing)
{
  CoSection task (options ()), others (options ());
  for (int sensor = 0; sensor < 2; ++sensor)
    for (CoSection* each : {&task, &others})
      show (scene_, sensor, {}, *each);
  const SceneResult fresh = others.reconstruct ();
  Eigen::Vector3f centre = Eigen::Vector3f::Zero ();
  for (const Eigen::Vector3f& vertex : fresh.objects.at (0).mesh.vertices)
    centre += vertex / static_cast<float> (fresh.objects[0].mesh.vertices.size ());
  std::vector<OrientedPoint> wrong; // a ball inside of it
  for (int n = 0; n < 500; ++n)
  {
    const float z = (static_cast<float> (n) + 0.5f) / 250.0f - 1.0f, turn = 2.4f * static_cast<float> (n);
    const float r = std::sqrt (1.0f - z * z);
    const Eigen::Vector3f normal (r * std::cos (turn), r * std::sin (turn), z);
    wrong.push_back ({centre + 0.03f * normal, normal});
  }
  task.addPoints (7, wrong);
  EXPECT_EQ (task.update (UpdateOutput::Fields).objects.size (), 2u);
  task.removeObject (7);
  task.removeObject (8); // no such object
  expectSameObjects (task.update (), fresh);
}

TEST_P (FollowScene, ViewsThatAreGivenUpLeaveNothing)
{
  CoSection task (options ());
  for (int sensor = 0; sensor < 4; ++sensor)
    show (scene_, sensor, {}, task);
  EXPECT_THROW (task.removeViews ({true}), InvalidArgument);
  task.removeViews ({false, true, false, true});
  CoSection others (options ());
  show (scene_, 0, {}, others);
  show (scene_, 2, {}, others);
  const SceneResult fresh = others.reconstruct ();
  const SceneResult left = task.reconstruct ();
  ASSERT_EQ (left.objects.at (0).error, "");
  EXPECT_EQ (left.objects[0].signed_distance->values, fresh.objects.at (0).signed_distance->values);
  EXPECT_EQ (left.background.vertices.size (), fresh.background.vertices.size ());
}

TEST_P (FollowScene, ViewsAreGivenUpBetweenUpdates)
{
  CoSection task (options ());
  for (int sensor = 0; sensor < 4; ++sensor)
    show (scene_, sensor, {}, task);
  task.update (UpdateOutput::Fields);
  task.removeViews ({false, true, false, true});
  const SceneResult followed = task.update ();
  expectSameObjects (followed, task.reconstruct ());
}

/** \brief A few points above the object are outliers until there are more of them. */
TEST_P (FollowScene, OutlierPointsAreNoLongerOnesWhenThereAreMany)
{
  const auto patch = [] (int side, float shift_m) {
    std::vector<OrientedPoint> points;
    for (int n = 0; n < side * side; ++n)
    {
      OrientedPoint point;
      point.position = Eigen::Vector3f (0.001f * (n % side) + shift_m, 0.001f * (n / side), 0.2f);
      point.normal = Eigen::Vector3f::UnitZ ();
      points.push_back (point);
    }
    return points;
  };
  CoSection task (options ());
  show (scene_, 0, {}, task);
  task.addPoints (1, patch (4, 0.0f));
  EXPECT_EQ (task.update (UpdateOutput::Fields).objects.at (0).outlier_points, 16u);
  show (scene_, 1, {}, task);
  EXPECT_EQ (task.update (UpdateOutput::Fields).objects.at (0).outlier_points, 16u);
  show (scene_, 2, {}, task);
  task.addPoints (1, patch (12, 0.0005f));
  const SceneResult followed = task.update ();
  EXPECT_EQ (followed.objects.at (0).outlier_points, 0u);
  expectSameObjects (followed, task.reconstruct ());
  task.removeViews ({false, false, true});
  const SceneResult before = task.update ();
  EXPECT_EQ (before.objects.at (0).outlier_points, 16u);
  expectSameObjects (before, task.reconstruct ());
}

INSTANTIATE_TEST_SUITE_P (Shapes, FollowScene, testing::Values (Shape::Sphere, Shape::Box, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

/** \brief A box slides over the table, past a ball. */
TEST (FollowMovingScene, UpdatesGiveWhatAFreshRunGives)
{
  CoSectionOptions options = optionsFor (voxel_m);
  options.whole_background = true;
  CoSection task (options);
  for (int step = 0; step < 4; ++step)
  {
    Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity ();
    T_world_box.translation () = Eigen::Vector3d (-0.09 + 0.02 * step, -0.02, 0.04);
    T_world_box.rotate (Eigen::AngleAxisd (0.2 * step, Eigen::Vector3d::UnitZ ()));
    AnalyticScene scene;
    scene.add (0, halfSpace (Eigen::Vector4d::UnitZ ()));
    scene.add (1, placed (box (Eigen::Vector3d (0.03, 0.04, 0.04)), T_world_box));
    scene.add (2, placed (sphere (0.04), Eigen::Vector3d (0.06, 0.02, 0.04)));
    show (scene, 0, {{1, T_world_box}}, task);
    task.update (UpdateOutput::Fields);
  }
  const SceneResult followed = task.update ();
  expectSameObjects (followed, task.reconstruct ());
  for (const ObjectResult& object : followed.objects)
    EXPECT_LT (object.penetration_m, 0.5 * 2.0 * voxel_m);
}

TEST (FollowMovingScene, ObjectsAndPointsComeWhenTheyCome)
{
  CoSectionOptions options = optionsFor (voxel_m);
  CoSection task (options);
  EXPECT_TRUE (task.update ().objects.empty ());
  EXPECT_THROW (task.addPoints (0, {}), InvalidArgument);
  task.addPoints (3, {});
  EXPECT_NE (task.update ().objects.at (0).error, "");
  const AnalyticScene scene = tableScene (Shape::Sphere);
  const RenderedView seen = scene.render (tableCamera (), around (0));
  task.addView (seen.view);
  task.addPoints (3, seen.points.at (1));
  EXPECT_EQ (task.update ().objects.at (0).error, "");
}
