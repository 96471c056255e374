// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Sequences whose poses and masks are known: which frames are used, and for what.

#include "common/message_of.h"
#include "completion/analytic_scene.h"
#include "io/sequence_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/fusion/sequence_fusion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int frames = 8, ball = 1, block = 2;

/** \brief A ball that rolls past a block at rest, seen by a camera that moves. */
class SequenceFusionTest : public testing::Test
{
protected:
  SequenceFusionTest ()
  {
    folder_.text ("calibration.txt", "90 90 39.5 29.5 80 60\n");
    for (int n = 0; n < frames; ++n)
    {
      AnalyticScene scene;
      scene.add (0, halfSpace (Eigen::Vector4d::UnitZ ()));
      scene.add (ball, placed (sphere (0.05), T_world_ball (n)));
      scene.add (block, placed (box ({0.04, 0.03, 0.03}), Eigen::Vector3d (0.1, 0.0, 0.03)));
      const RenderedView seen = scene.render (camera_, T_world_camera (n));
      Image<float> depth (camera_.width, camera_.height);
      depth.pixels = seen.view.depth;
      Image<std::uint16_t> mask (camera_.width, camera_.height);
      for (std::size_t p = 0; p < mask.pixels.size (); ++p)
        mask.pixels[p] = static_cast<std::uint16_t> (std::max (0, seen.labels[p]));
      saveDepthImage (depth, folder_.newPath (depthName (n)));
      saveMaskImage (mask, folder_.newPath (maskName (n)));
      camera_poses_.push_back ({static_cast<double> (n), T_world_camera (n)});
      ball_poses_.push_back ({static_cast<double> (n), T_world_ball (n)});
    }
  }

  static std::string depthName (int n) { return "depth/Depth" + SequenceFolder::fourDigits (n) + ".png"; }

  static std::string maskName (int n) { return "mask/Mask" + SequenceFolder::fourDigits (n) + ".png"; }

  static Eigen::Isometry3d T_world_ball (int n)
  {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
    T.translate (Eigen::Vector3d (-0.1 + 0.01 * n, 0.0, 0.05));
    return T;
  }

  static Eigen::Isometry3d T_world_camera (int n) { return lookAt ({-0.1 + 0.02 * n, -0.4, 0.3}, {0.0, 0.0, 0.04}); }

  void remove (const std::string& name) const { std::filesystem::remove (folder_.path (name)); }

  FusionResult run (const FusionOptions& options, const SequenceFusion::KeyframeCallback& report = {},
                    bool masks = true) const
  {
    const RgbdSequence images (folder_.path ());
    std::optional<MaskSequence> mask_sequence;
    KnownSequence known;
    known.images = &images;
    known.camera = camera_poses_;
    if (masks)
    {
      mask_sequence.emplace (folder_.path ("mask"), images);
      known.masks = &*mask_sequence;
      known.objects[ball] = ball_poses_;
    }
    return SequenceFusion (known, options).run ({}, report);
  }

  static FusionOptions every (int keyframe_every)
  {
    FusionOptions options;
    options.keyframe_every = keyframe_every;
    options.backend.method.voxel_size_m = 0.008;
    options.tsdf.resolution = 16;
    return options;
  }

  static std::vector<double> stampsOf (const std::vector<StampedPose>& poses)
  {
    std::vector<double> stamps;
    for (const StampedPose& pose : poses)
      stamps.push_back (pose.stamp);
    return stamps;
  }

  /** \brief The stamps of the keyframes. */
  std::vector<double> keyframesOf (FusionOptions options) const
  {
    options.updates = KeyframeUpdates::InStep;
    std::vector<double> stamps;
    run (options, [&] (const KeyframeReport& report) { stamps.push_back (report.stamp); });
    return stamps;
  }

  const PinholeCamera camera_{80, 60, 90.0, 90.0, 39.5, 29.5};
  const SequenceFolder folder_;
  std::vector<StampedPose> camera_poses_, ball_poses_;
};

using Stamps = std::vector<double>;

} // namespace

TEST_F (SequenceFusionTest, ObjectsAreCompletedInTheirFrames)
{
  const FusionResult result = run (every (3));
  EXPECT_EQ (result.frames, 8u);
  EXPECT_EQ (result.keyframes, 3u);
  EXPECT_EQ (result.kept_keyframes, 3u);
  ASSERT_EQ (result.scene.objects.size (), 2u);
  for (const ObjectResult& object : result.scene.objects)
  {
    ASSERT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
    const Eigen::Vector3d centre = object.id == ball ? Eigen::Vector3d::Zero () : Eigen::Vector3d (0.1, 0.0, 0.03);
    EXPECT_LT ((computeMassProperties (object.mesh).centroid_m - centre).norm (), 0.02) << object.id;
    EXPECT_FALSE (result.objects.at (object.id).tsdf.empty ());
  }
  for (const Eigen::Vector3f& vertex : result.objects.at (ball).tsdf.vertices)
    EXPECT_NEAR (vertex.norm (), 0.05, 0.01);
  EXPECT_TRUE (mentions (result.warnings, "object 2 of the masks has no trajectory: it is taken to be at rest"));
  EXPECT_FALSE (mentions (result.warnings, "object 1"));
  EXPECT_EQ (stampsOf (result.objects.at (block).trajectory).size (), 8u);
  for (const StampedPose& pose : result.objects.at (block).trajectory)
    EXPECT_TRUE (pose.pose.isApprox (Eigen::Isometry3d::Identity ()));
}

TEST_F (SequenceFusionTest, AMaskThatMissesAnObjectMakesItNoBackground)
{
  const auto volumeOfBlock = [&] {
    const FusionResult result = run (every (3));
    const auto found = std::find_if (result.scene.objects.begin (), result.scene.objects.end (),
                                     [] (const ObjectResult& object) { return object.id == block; });
    return found == result.scene.objects.end () ? 0.0 : computeMassProperties (found->mesh).volume_m3;
  };
  const double with_all = volumeOfBlock ();
  Image<std::uint16_t> mask = loadMaskImage (folder_.path (maskName (3))); // of a keyframe
  std::replace (mask.pixels.begin (), mask.pixels.end (), static_cast<std::uint16_t> (block), std::uint16_t{0});
  saveMaskImage (mask, folder_.path (maskName (3)));
  EXPECT_NEAR (volumeOfBlock (), with_all, 0.2 * with_all);
}

TEST_F (SequenceFusionTest, PosesOfAnotherUnitThanTheDepthAreWarnedOf)
{
  const char* const warning = "its poses must be in metres";
  EXPECT_FALSE (mentions (run (every (4)).warnings, warning));
  for (StampedPose& pose : camera_poses_)
    pose.pose.translation () *= 1000.0;
  EXPECT_TRUE (mentions (run (every (4)).warnings, warning));
}

TEST_F (SequenceFusionTest, GapsInPosesStayGaps)
{
  camera_poses_.erase (camera_poses_.begin () + 2, camera_poses_.begin () + 4);
  ball_poses_.erase (ball_poses_.begin () + 4, ball_poses_.end ());
  const FusionResult result = run (every (3));
  EXPECT_EQ (result.frames, 6u);
  EXPECT_EQ (stampsOf (result.camera), (Stamps{0, 1, 4, 5, 6, 7}));
  EXPECT_EQ (stampsOf (result.objects.at (ball).trajectory), (Stamps{0, 1}));
  EXPECT_TRUE (mentions (result.warnings, "2 of 8 frames were left out: the camera's trajectory has no pose for them"));
  EXPECT_TRUE (mentions (result.warnings, "points of objects were left out"));
}

TEST_F (SequenceFusionTest, KeyframesWaitForAMaskAndAPose)
{
  EXPECT_EQ (keyframesOf (every (3)), (Stamps{0, 3, 6}));
  remove (maskName (0));
  remove (maskName (6));
  EXPECT_EQ (keyframesOf (every (3)), (Stamps{1, 3, 7}));
  camera_poses_.erase (camera_poses_.begin () + 3);
  EXPECT_EQ (keyframesOf (every (3)), (Stamps{1, 4, 7}));
  writeFile (folder_.path (maskName (4)), "damaged");
  EXPECT_EQ (keyframesOf (every (3)), (Stamps{1, 5, 7}));
  writeFile (folder_.path (depthName (5)), "damaged");
  EXPECT_EQ (keyframesOf (every (3)), (Stamps{1, 7}));
}

TEST_F (SequenceFusionTest, OnlyTheRangeIsUsed)
{
  FusionOptions options = every (2);
  options.frames = {3, 7};
  const FusionResult result = run (options);
  EXPECT_EQ (stampsOf (result.camera), (Stamps{3, 4, 5, 6}));
  EXPECT_EQ (result.keyframes, 2u);
  options.frames = {6, 20};
  EXPECT_TRUE (mentions (run (options).warnings, "frames from 8 on are not there; the sequence has 0:8"));
  options.frames.last = FrameRange ().last;
  EXPECT_FALSE (mentions (run (options).warnings, "are not there"));
  options.frames.first = 8;
  EXPECT_EQ (messageOf<InvalidArgument> ([&] { run (options); }),
             "the frames from 8 on are not there; the sequence has 0:8");
}

TEST_F (SequenceFusionTest, WithoutMasksThereIsOnlyBackground)
{
  const FusionResult result = run (every (4), {}, false);
  EXPECT_TRUE (result.scene.objects.empty ());
  EXPECT_TRUE (result.objects.empty ());
  EXPECT_FALSE (result.scene.background.empty ());
  EXPECT_TRUE (result.warnings.empty ());
}

TEST_F (SequenceFusionTest, AFewPixelsAreNoObject)
{
  for (int n = 0; n < frames; ++n)
  {
    Image<std::uint16_t> mask = loadMaskImage (folder_.path (maskName (n)));
    for (int u = 30; u < 36; ++u)
      for (int v = 45; v < 50; ++v)
        mask.at (u, v) = 500;
    saveMaskImage (mask, folder_.newPath (maskName (n)), true);
  }
  const FusionResult result = run (every (4));
  EXPECT_EQ (result.scene.objects.size (), 2u);
  EXPECT_EQ (result.objects.count (500), 0u);
  EXPECT_TRUE (mentions (result.warnings, "object 500 was left out: it has only "));
  EXPECT_TRUE (mentions (result.warnings, "points in all keyframes; 100 are needed"));
}

TEST_F (SequenceFusionTest, AnObjectThatOnlyFramesBetweenKeyframesShowIsCompleted)
{
  for (int n = 0; n < frames; ++n)
    if (n != 5)
    {
      Image<std::uint16_t> mask = loadMaskImage (folder_.path (maskName (n)));
      std::replace (mask.pixels.begin (), mask.pixels.end (), std::uint16_t (ball), std::uint16_t (0));
      saveMaskImage (mask, folder_.newPath (maskName (n)), true);
    }
  const FusionResult result = run (every (4));
  EXPECT_EQ (result.keyframes, 3u); // 0, 4 and that one
  EXPECT_EQ (result.scene.objects.size (), 2u);
  EXPECT_GT (result.objects.at (ball).points, 100u);
}

TEST_F (SequenceFusionTest, AnUnseenObjectIsToldAndHasNoTrajectory)
{
  for (int n = 0; n < frames; ++n)
    saveMaskImage (Image<std::uint16_t> (camera_.width, camera_.height), folder_.newPath (maskName (n)));
  const FusionResult result = run (every (4));
  EXPECT_TRUE (result.objects.empty ());
  EXPECT_TRUE (mentions (result.warnings, "object 1 has a trajectory, but no points in any keyframe"));
  EXPECT_FALSE (result.scene.background.empty ());
}

TEST_F (SequenceFusionTest, WhatCannotBeUsedIsRefused)
{
  const FusionOptions options = every (3);
  FusionOptions near = options;
  near.keyframe.max_depth_m = 0.1;
  EXPECT_EQ (messageOf<IoError> ([&] { run (near); }), "no keyframe has a surface nearer than 0.1 m");
  FusionOptions never = options;
  never.keyframe_every = 0;
  EXPECT_THROW (run (never), InvalidArgument);

  for (int n = 0; n < frames; ++n)
    saveMaskImage (Image<std::uint16_t> (4, 4), folder_.newPath (maskName (n)));
  EXPECT_NE (messageOf<IoError> ([&] { run (options); }).find ("no frame has a mask that can be used: "),
             std::string::npos);
  for (int n = 0; n < frames; ++n)
    writeFile (folder_.path (depthName (n)), "damaged");
  EXPECT_NE (messageOf<IoError> ([&] { run (options, {}, false); }).find ("no frame can be read: "), std::string::npos);
  for (StampedPose& pose : camera_poses_)
    pose.stamp += 100.0;
  EXPECT_NE (messageOf<InvalidArgument> ([&] {
               run (options, {}, false);
             }).find ("its stamps are 100 to 107, those of the frames 0 to 7"),
             std::string::npos);
  camera_poses_.clear ();
  EXPECT_THROW (run (options, {}, false), InvalidArgument);
  EXPECT_THROW (SequenceFusion ({}, options), InvalidArgument);
}

TEST_F (SequenceFusionTest, UpdatesChangeNoResult)
{
  const FusionResult plain = run (every (3));
  for (const KeyframeUpdates updates : {KeyframeUpdates::InStep, KeyframeUpdates::Beside})
  {
    FusionOptions options = every (3);
    options.updates = updates;
    std::vector<double> stamps;
    const FusionResult result = run (options, [&] (const KeyframeReport& report) { stamps.push_back (report.stamp); });
    ASSERT_FALSE (stamps.empty ());
    EXPECT_EQ (stamps.back (), 6.0) << "the last is always completed";
    EXPECT_TRUE (std::is_sorted (stamps.begin (), stamps.end ()));
    ASSERT_EQ (result.scene.objects.size (), plain.scene.objects.size ());
    for (std::size_t n = 0; n < plain.scene.objects.size (); ++n)
      EXPECT_EQ (result.scene.objects[n].mesh.vertices, plain.scene.objects[n].mesh.vertices) << n;
    EXPECT_EQ (result.scene.background.vertices, plain.scene.background.vertices);
  }
}

/** \brief Whatever the back end does then. */
TEST_F (SequenceFusionTest, UpdatesBesideEndWithTheRun)
{
  const RgbdSequence images (folder_.path ());
  KnownSequence known;
  known.images = &images;
  known.camera = camera_poses_;
  FusionOptions options = every (2);
  options.updates = KeyframeUpdates::Beside;
  const SequenceFusion fusion (known, options);
  for (const double until : {0.0, 0.2, 0.4, 0.7})
    EXPECT_THROW (fusion.run ([&] (const std::string&, double done) { return done < until; }), Cancelled) << until;
  EXPECT_THROW (fusion.run ({}, [] (const KeyframeReport&) { throw std::runtime_error ("the user's"); }),
                std::runtime_error);
}

TEST_F (SequenceFusionTest, CanBeCancelled)
{
  const RgbdSequence images (folder_.path ());
  KnownSequence known;
  known.images = &images;
  known.camera = camera_poses_;
  for (const double until : {0.2, 0.7})
    EXPECT_THROW (
        SequenceFusion (known, every (3)).run ([&] (const std::string&, double done) { return done < until; }),
        Cancelled);
}

TEST_F (SequenceFusionTest, IgnoredPixelsAreNotCompleted)
{
  for (int n = 0; n < frames; ++n)
  {
    Image<std::uint16_t> mask = loadMaskImage (folder_.path (maskName (n)));
    std::replace (mask.pixels.begin (), mask.pixels.end (), static_cast<std::uint16_t> (block), ignored_label);
    saveMaskImage (mask, folder_.path (maskName (n)), true);
  }
  const FusionResult result = run (every (3));
  EXPECT_EQ (result.objects.size (), 1u);
  EXPECT_EQ (result.objects.count (ball), 1u);
}
