// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/temporary_folder.h"
#include "moving_scene.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <gtest/gtest.h>

#include <filesystem>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const ObjectEvaluation&
objectOf (const RunEvaluation& run, const std::string& name)
{
  for (const ObjectEvaluation& object : run.objects)
    if (object.truth_name == name)
      return object;
  throw std::runtime_error ("no object " + name);
}

} // namespace

TEST (RunEvaluation, OtherFramesAreNoError)
{
  const SceneRecord truth = movingScene ();
  const RunEvaluation run = evaluateRun (truth, inOtherFrames (truth));
  EXPECT_LT (run.camera.ate_m.max, 1e-6);
  ASSERT_EQ (run.objects.size (), 2u);
  EXPECT_EQ (objectOf (run, "box").id, 7);
  EXPECT_EQ (objectOf (run, "torus").id, 8);
  for (const ObjectEvaluation& object : run.objects)
  {
    EXPECT_LT (object.mesh.comparison.accuracy.mean, 1e-5) << object.truth_name;
    EXPECT_LT (object.mesh.comparison.completeness.mean, 1e-5) << object.truth_name;
    EXPECT_EQ (object.mesh.comparison.f_score, 1.0);
    EXPECT_TRUE (object.mesh.estimate.topology.closed_manifold);
    ASSERT_TRUE (object.mesh.volume_error);
    EXPECT_NEAR (*object.mesh.volume_error, 0.0, 1e-4);
    EXPECT_LT (object.trajectory.ate_m.max, 1e-5);
    EXPECT_LT (object.trajectory.rpe_trans_m.max, 1e-5);
    EXPECT_EQ (object.frames_tracked, 24u);
    EXPECT_EQ (object.frames_visible, 24u);
    EXPECT_EQ (object.frames_tracked_visible, 24u);
    EXPECT_EQ (object.penetration_m, 0.0);
    EXPECT_EQ (object.mesh.alignment.frames, 24u);
  }
  ASSERT_TRUE (run.background);
  EXPECT_LT (run.background->comparison.completeness.mean, 1e-5);
  EXPECT_EQ (run.penetrations.size (), 3u);
  EXPECT_TRUE (run.unmatched.empty ());
  EXPECT_TRUE (run.missed.empty ());
  EXPECT_TRUE (run.warnings.empty ());
}

TEST (RunEvaluation, TracksWithErrorsAreMeasured)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  // The box is off by 1 cm in the camera's frame, in every second frame to either side: its median is right.
  for (std::size_t n = 0; n < 24; ++n)
  {
    const Eigen::Isometry3d camera = estimate.camera[n].pose;
    const Eigen::Vector3d shift = camera.linear () * Eigen::Vector3d (n % 2 == 0 ? 0.01 : -0.01, 0.0, 0.0);
    estimate.objects[0].poses[n].pose.translation () += shift;
  }
  const RunEvaluation run = evaluateRun (truth, estimate);
  const ObjectEvaluation& box = objectOf (run, "box");
  EXPECT_NEAR (box.trajectory.ate_m.rmse, 0.01, 0.002);
  EXPECT_NEAR (box.trajectory.rpe_trans_m.rmse, 0.02, 1e-4); // does not depend on the alignment
  EXPECT_LT (objectOf (run, "torus").trajectory.ate_m.max, 1e-5);
  EXPECT_LT (box.mesh.comparison.accuracy.mean, 0.002); // refined
}

TEST (RunEvaluation, RefinementIsReportedAndCanBeOff)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  const Eigen::Isometry3d off = motion (0.0, Eigen::Vector3d::UnitX (), {0.006, 0.005, 0.0});
  for (StampedPose& pose : estimate.objects[0].poses)
    pose.pose = pose.pose * off;
  const RunEvaluation refined = evaluateRun (truth, estimate);
  EXPECT_NEAR (objectOf (refined, "box").mesh.alignment.refinement.translation_m, std::hypot (0.006, 0.005), 1e-4);
  EXPECT_LT (objectOf (refined, "box").mesh.comparison.accuracy.max, 1e-4);
  RunOptions options;
  options.refine = false;
  const RunEvaluation median = evaluateRun (truth, estimate, options);
  EXPECT_EQ (objectOf (median, "box").mesh.alignment.refinement.translation_m, 0.0);
  EXPECT_GT (objectOf (median, "box").mesh.comparison.accuracy.mean, 0.002);
  EXPECT_LT (objectOf (median, "box").trajectory.ate_m.max, 1e-5); // a constant offset is the frame's
}

TEST (RunEvaluation, OnlyObservedVerticesAlign)
{
  // What was not observed is 1.5 cm too large; it must not pull.
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  TriangleMesh& torus = estimate.objects[1].mesh;
  const TriangleMesh& original = truth.objects[0].mesh;
  for (std::size_t v = 0; v < torus.vertices.size (); ++v)
  {
    const bool observed = original.normals[v].x () > -0.2f;
    torus.provenance.push_back (static_cast<std::uint8_t> (observed ? Provenance::Observed : Provenance::Inferred));
    if (!observed)
      torus.vertices[v] += 0.015f * torus.normals[v];
  }
  const RunEvaluation run = evaluateRun (truth, estimate);
  const MeshEvaluation& mesh = objectOf (run, "torus").mesh;
  EXPECT_LT (mesh.alignment.refinement.translation_m, 1e-4);
  EXPECT_NEAR (mesh.comparison.accuracy.max, 0.015, 1e-3);
}

TEST (RunEvaluation, SaysWhatIsMissingAndEvaluatesTheRest)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  // The torus is lost in the second half, the box is not found, and there is something that does not exist.
  estimate.objects[1].poses.resize (12);
  estimate.objects[0].mesh = sphereMesh (0.05, 12);
  for (StampedPose& pose : estimate.objects[0].poses)
    pose.pose.translation ().x () += 3.0;
  SceneRecord::Object empty;
  empty.id = 12;
  empty.name = "12";
  empty.poses = estimate.objects[0].poses;
  estimate.objects.push_back (empty);
  estimate.background = {};
  const RunEvaluation run = evaluateRun (truth, estimate);
  ASSERT_EQ (run.objects.size (), 1u);
  EXPECT_EQ (run.objects[0].id, 8);
  EXPECT_EQ (run.objects[0].frames_tracked, 12u);
  EXPECT_EQ (run.objects[0].frames_tracked_visible, 12u);
  EXPECT_EQ (run.objects[0].frames_visible, 24u);
  EXPECT_LT (run.objects[0].mesh.comparison.accuracy.mean, 1e-5);
  EXPECT_EQ (run.unmatched, (std::vector<int>{7, 12}));
  EXPECT_EQ (run.missed, (std::vector<int>{2}));
  EXPECT_FALSE (run.background);
  ASSERT_EQ (run.warnings.size (), 2u);
  EXPECT_NE (run.warnings[0].find ("estimated object 12 has no mesh"), std::string::npos);
  EXPECT_NE (run.warnings[1].find ("no background"), std::string::npos);
}

TEST (RunEvaluation, HiddenObjectsAreNotVisible)
{
  SceneRecord truth = movingScene ();
  for (std::size_t n = 0; n < 6; ++n) // below the floor
    truth.objects[1].poses[n].pose.translation ().z () = -0.5;
  const RunEvaluation run = evaluateRun (truth, inOtherFrames (truth));
  EXPECT_EQ (objectOf (run, "box").frames_visible, 18u);
  EXPECT_EQ (objectOf (run, "torus").frames_visible, 24u);
}

TEST (RunEvaluation, PenetrationIsThatOfTheDeepestFrame)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  // In one frame the box, 5 cm above the floor and 4 cm thick below its centre, is 3 cm lower: 2 cm in the floor.
  const Eigen::Vector3d down = truth.camera.front ().pose.linear ().transpose () * Eigen::Vector3d (0.0, 0.0, -0.03);
  estimate.objects[0].poses[9].pose.translation () += down;
  const RunEvaluation run = evaluateRun (truth, estimate);
  const ObjectEvaluation& box = objectOf (run, "box");
  EXPECT_NEAR (box.penetration_m, 0.02, 1e-4);
  EXPECT_FALSE (box.penetration_m3); // with an open floor, and not with the torus
  for (const PairPenetration& pair : run.penetrations)
    if (pair.first == 7 && pair.second == PairPenetration::background)
    {
      EXPECT_EQ (pair.stamp, 9.0);
      EXPECT_EQ (pair.frames, 24u);
    }
}

TEST (RunEvaluation, TheVolumeOfPenetrationIsKnownOfClosedBodies)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  SceneRecord::Object block;
  block.id = 20;
  block.name = "20";
  block.mesh = boxMesh ({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f});
  for (const StampedPose& pose : truth.objects[1].poses) // 2 cm of the box's 20 cm are in the block
    block.poses.push_back ({pose.stamp, truth.camera.front ().pose.inverse () * pose.pose *
                                            motion (0.0, Eigen::Vector3d::UnitX (), {0.18, 0.0, 0.0})});
  estimate.objects.push_back (block);
  const RunEvaluation run = evaluateRun (truth, estimate);
  const ObjectEvaluation& box = objectOf (run, "box");
  EXPECT_NEAR (box.penetration_m, 0.02, 1e-5);
  ASSERT_TRUE (box.penetration_m3);
  EXPECT_NEAR (*box.penetration_m3, 0.02 * 0.12 * 0.08, 0.05 * 0.02 * 0.12 * 0.08);
}

TEST (RunEvaluation, DoesNotDependOnThreads)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  for (auto& v : estimate.objects[1].mesh.vertices)
    v *= 1.02f;
  RunOptions options;
  options.threads = 1;
  const RunEvaluation one = evaluateRun (truth, estimate, options);
  options.threads = 3;
  const RunEvaluation three = evaluateRun (truth, estimate, options);
  for (std::size_t n = 0; n < 2; ++n)
  {
    EXPECT_EQ (one.objects[n].mesh.comparison.accuracy.mean, three.objects[n].mesh.comparison.accuracy.mean);
    EXPECT_EQ (one.objects[n].mesh.alignment.T_truth_estimate.matrix (),
               three.objects[n].mesh.alignment.T_truth_estimate.matrix ());
    EXPECT_EQ (one.objects[n].penetration_m, three.objects[n].penetration_m);
  }
}

TEST (RunEvaluation, ACameraOfOtherTimesIsAnError)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  for (StampedPose& pose : estimate.camera)
    pose.stamp += 1000.0;
  EXPECT_THROW (evaluateRun (truth, estimate), DegenerateInput);
}

TEST (RunEvaluation, ViewsAreFoundAmongTheFramesOfTheirTruth)
{
  const TemporaryFolder folder;
  const auto posesFrom = [] (std::vector<int> places) {
    std::vector<StampedPose> poses;
    for (const int place : places)
    {
      poses.emplace_back ();
      poses.back ().stamp = static_cast<double> (poses.size ()) - 1.0;
      poses.back ().pose.translation ().x () = 0.1 * place;
    }
    return poses;
  };
  saveTrajectory (posesFrom ({0, 1, 2, 3, 4}), folder.file ("gt-cam-0.txt"));
  saveTrajectory (posesFrom ({5, 6, 7, 8, 9}), folder.file ("gt-can-3.txt"));
  ReadingNotes notes;
  SceneRecord truth = readTruthOfViews (folder.file (""), posesFrom ({4, 2}), notes);
  ASSERT_EQ (truth.camera.size (), 2u);
  EXPECT_NEAR (truth.camera[0].pose.translation ().x (), 0.4, 1e-9);
  ASSERT_EQ (truth.objects.size (), 1u);
  EXPECT_NEAR (truth.objects[0].poses.at (0).pose.translation ().x (), 0.9, 1e-9);
  EXPECT_NEAR (truth.objects[0].poses.at (1).pose.translation ().x (), 0.7, 1e-9);
  EXPECT_THROW (readTruthOfViews (folder.file (""), posesFrom ({6}), notes), IoError); // of another sequence

  std::filesystem::create_directory (folder.file ("views")); // every second frame
  saveTrajectory (posesFrom ({0, 2, 4}), folder.file ("views/gt-cam-0.txt"));
  saveTrajectory (posesFrom ({5, 7, 9}), folder.file ("views/gt-can-3.txt"));
  truth = readTruthOfViews (folder.file (""), posesFrom ({2}), notes);
  EXPECT_NEAR (truth.objects.at (0).poses.at (0).pose.translation ().x (), 0.7, 1e-9);
}
