// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "io/sequence_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Expect that frame \a index is the one that SequenceFolder wrote as frame \a written. */
void
expectFrame (const RgbdSequence& sequence, std::size_t index, int written, double unit_m)
{
  std::vector<std::string> warnings;
  const RgbdFrame frame = sequence.read (index, warnings);
  EXPECT_EQ (frame.index, index);
  EXPECT_EQ (frame.stamp, sequence.stamp (index));
  expectSameDepth (SequenceFolder::depthOf (written), frame.depth, unit_m);
  EXPECT_EQ (frame.colour.pixels, SequenceFolder::colourOf (written).pixels);
  EXPECT_TRUE (warnings.empty ()) << warnings[0];
}

} // namespace

TEST (RgbdSequence, ReadsTheCoFusionLayout)
{
  SequenceFolder folder;
  folder.coFusion ({12, 13, 14});
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.format (), SequenceFormat::CoFusion);
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{12, 13, 14}));
  EXPECT_EQ (sequence.period (), 1.0);
  EXPECT_TRUE (sequence.warnings ().empty ());
  const PinholeCamera& camera = sequence.camera ();
  EXPECT_EQ (camera.width, 8);
  EXPECT_EQ (camera.height, 6);
  EXPECT_EQ (camera.fx, 10.0);
  EXPECT_EQ (camera.fy, 11.0);
  EXPECT_EQ (camera.cx, 3.5);
  EXPECT_EQ (camera.cy, 2.5);
  for (int n = 0; n < 3; ++n)
    expectFrame (sequence, n, 12 + n, 1e-3);
}

TEST (RgbdSequence, NumbersHaveAnyDigitsAndGaps)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5");
  for (const int number : {7, 8, 9, 10, 100000, 12})
  {
    folder.depth ("depth/depth" + std::to_string (number) + ".exr", number % 100); // 10 comes before 8 by name
    folder.colour ("color/" + SequenceFolder::fourDigits (number) + ".PNG", number % 100);
  }
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{7, 8, 9, 10, 12, 100000}));
  EXPECT_EQ (sequence.period (), 1.0);
  EXPECT_TRUE (mentions (sequence.warnings (), "missing after " + folder.path ("depth/depth10.exr")));
  EXPECT_EQ (sequence.camera ().width, 8); // of the first image
  EXPECT_EQ (sequence.camera ().height, 6);
  for (std::size_t n = 0; n < sequence.size (); ++n)
    expectFrame (sequence, n, static_cast<int> (sequence.stamp (n)) % 100, 0.0);
}

TEST (RgbdSequence, NoisyDepthComesBeforeExactUnlessAskedFor)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  folder.depth ("depth_noise/Depth0000.png", 3);
  folder.depth ("more/Depth0000.png", 5, 200.0);
  std::vector<std::string> warnings;
  EXPECT_NEAR (RgbdSequence (folder.path ()).read (0, warnings).depth.pixels[0], 1.3, 1e-3);
  SequenceSource source;
  source.depth_folder = "depth";
  EXPECT_NEAR (RgbdSequence (folder.path (), source).read (0, warnings).depth.pixels[0], 1.0, 1e-3);
  source.depth_folder = "more";
  source.depth_scale = 200.0;
  EXPECT_NEAR (RgbdSequence (folder.path (), source).read (0, warnings).depth.pixels[0], 1.5, 3e-3);
  EXPECT_EQ (RgbdSequence (folder.path (), source).depthScale (), 200.0);
  std::filesystem::remove (folder.path ("depth_noise/Depth0000.png")); // an empty folder does not count
  EXPECT_NEAR (RgbdSequence (folder.path ()).read (0, warnings).depth.pixels[0], 1.0, 1e-3);
}

TEST (RgbdSequence, WhatDoesNotFitIntoSixteenBitsIsNoReading)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  cv::Mat depth (6, 8, CV_16U, cv::Scalar (1500));
  depth.at<std::uint16_t> (2, 3) = 65535;
  cv::imwrite (folder.path ("depth/Depth0000.png"), depth);
  std::vector<std::string> warnings;
  const RgbdFrame frame = RgbdSequence (folder.path ()).read (0, warnings);
  EXPECT_TRUE (std::isnan (frame.depth.at (3, 2)));
  EXPECT_EQ (frame.depth.at (4, 2), 1.5f);
}

TEST (RgbdSequence, AssociationsHaveSeveralNames)
{
  for (const char* name : {"associate.txt", "Association.txt", "assoc.txt"})
  {
    SequenceFolder folder;
    folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
    folder.text (name, "0.1 rgb/0.png 0.1 depth/0.png\n");
    folder.depth ("depth/0.png", 0, 5000.0);
    folder.colour ("rgb/0.png", 0);
    EXPECT_EQ (RgbdSequence (folder.path ()).format (), SequenceFormat::Tum) << name;
    EXPECT_EQ (RgbdSequence (folder.path ()).stamp (0), 0.1) << name;
  }
}

class Associations : public testing::TestWithParam<const char*>
{};

TEST_P (Associations, AreOfEitherOrder)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("associations.txt", GetParam ());
  for (int n = 0; n < 2; ++n)
  {
    folder.depth ("depth/" + std::to_string (n) + ".png", n, 5000.0);
    folder.colour ("rgb/" + std::to_string (n) + ".png", n);
    folder.depth ("a/" + std::to_string (n) + ".exr", n);
    folder.colour ("b/" + std::to_string (n) + ".png", n);
  }
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.format (), SequenceFormat::Tum);
  ASSERT_EQ (sequence.size (), 2u);
  EXPECT_EQ (sequence.stamp (0), 1305031453.36); // of the depth
  EXPECT_EQ (sequence.stamp (1), 1305031453.39);
  EXPECT_NEAR (sequence.period (), 0.03, 1e-6);
  for (int n = 0; n < 2; ++n)
    expectFrame (sequence, n, n, 2e-4);
}

INSTANTIATE_TEST_SUITE_P (
    RgbdSequence, Associations,
    testing::Values (
        "# comment\n1305031453.35 rgb/0.png 1305031453.36 depth/0.png\n\n1305031453.38 rgb/1.png 1305031453.39 "
        "depth/1.png",
        "1305031453.36 depth/0.png 1305031453.35 rgb/0.png\r\n1305031453.39 depth/1.png 1305031453.38 rgb/1.png\r\n",
        "1305031453.36 a/0.exr 1305031453.35 b/0.png\n1305031453.39 a/1.exr 1305031453.38 b/1.png\n",
        "1305031453.35 b/0.png 1305031453.36 a/0.exr\n1305031453.38 b/1.png 1305031453.39 a/1.exr\n",
        "1305031453.38 rgb/1.png 1305031453.39 depth/1.png\n1305031453.35 rgb/0.png 1305031453.36 depth/0.png"));

TEST (RgbdSequence, TumListsAreAssociatedByTime)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("depth.txt",
               "0.000 depth/0.png\n0.033 depth/1.png\n0.036 depth/2.png\n0.100 depth/3.png\n0.133 depth/4.png\n");
  folder.text ("rgb.txt", "0.147 rgb/4.png\n0.015 rgb/0.png\n0.035 rgb/2.png\n0.200 rgb/9.png\n"); // in any order
  for (int n = 0; n < 5; ++n)
    folder.depth ("depth/" + std::to_string (n) + ".png", n, 5000.0);
  for (const int n : {0, 2, 4, 9})
    folder.colour ("rgb/" + std::to_string (n) + ".png", n);
  const RgbdSequence sequence (folder.path ());
  ASSERT_EQ (sequence.size (), 5u);
  EXPECT_EQ (sequence.depthScale (), 5000.0);
  EXPECT_EQ (sequence.files (0).colour, folder.path ("rgb/0.png"));
  EXPECT_EQ (sequence.files (1).colour, "") << "the nearest is another frame's";
  EXPECT_EQ (sequence.files (2).colour, folder.path ("rgb/2.png"));
  EXPECT_EQ (sequence.files (3).colour, "") << "more than 0.02 s away";
  expectFrame (sequence, 4, 4, 2e-4);
  EXPECT_TRUE (mentions (sequence.warnings (), "and 1 more have no colour image"));

  std::filesystem::remove (folder.path ("rgb.txt"));
  const RgbdSequence without (folder.path ());
  EXPECT_TRUE (mentions (without.warnings (), "rgb.txt"));
  std::vector<std::string> warnings;
  EXPECT_TRUE (without.read (2, warnings).colour.pixels.empty ());
  expectSameDepth (SequenceFolder::depthOf (2), without.read (2, warnings).depth, 2e-4);
}

TEST (RgbdSequence, ColourImagesWithoutDepthAreWarnedOf)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  folder.colour ("colour/Color0003.png", 3);
  folder.colour ("colour/Color0004.png", 4);
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.size (), 3u);
  EXPECT_EQ (sequence.warnings (),
             std::vector<std::string>{folder.path ("colour/Color0003.png") +
                                      " and 1 more: no depth image has the same number; there are 5 colour images and "
                                      "3 depth images"});
}

TEST (RgbdSequence, StampsAreSortedAndUnique)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("depth.txt", "2 depth/2.png\n0 depth/0.png\n1 depth/1.png\n1.0 depth/0.png\n");
  for (int n = 0; n < 3; ++n)
    folder.depth ("depth/" + std::to_string (n) + ".png", n, 5000.0);
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ (sequence.files (1).depth, folder.path ("depth/1.png")) << "the first in the list";
  EXPECT_TRUE (mentions (sequence.warnings (), "do not ascend"));
  EXPECT_TRUE (mentions (sequence.warnings (), "same stamp"));
}

TEST (RgbdSequence, ReadsSevenScenes)
{
  SequenceFolder folder;
  for (int n = 0; n < 3; ++n)
  {
    const std::string name = "frame-00000" + std::to_string (n);
    Image<float> depth (640, 480, 2.0f);
    depth.pixels[5] = 65.535f; // no reading
    saveDepthImage (depth, folder.newPath ("seq-01/" + name + ".depth.png"));
    folder.colour ("seq-01/" + name + ".color.png", n, 640, 480);
  }
  folder.text ("seq-01/frame-000000.pose.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.text ("seq-01/frame-000001.pose.txt", "-1.#IND -1.#IND -1.#IND 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n");
  folder.text ("seq-01/frame-000002.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const RgbdSequence sequence (folder.path ("seq-01"));
  EXPECT_EQ (sequence.format (), SequenceFormat::SevenScenes);
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ (sequence.camera ().fx, 585.0);
  EXPECT_EQ (sequence.camera ().cx, 320.0);
  EXPECT_EQ (sequence.camera ().width, 640);
  std::vector<std::string> warnings;
  const RgbdFrame frame = sequence.read (1, warnings);
  EXPECT_TRUE (std::isnan (frame.depth.pixels[5]));
  EXPECT_EQ (frame.depth.pixels[4], 2.0f);
  EXPECT_EQ (frame.colour.pixels[0][0], 1);
  EXPECT_TRUE (warnings.empty ());

  const std::vector<StampedPose> poses = sequence.givenTrajectory (warnings);
  ASSERT_EQ (poses.size (), 1u);
  EXPECT_EQ (poses[0].stamp, 0.0);
  EXPECT_LT ((poses[0].pose * Eigen::Vector3d (1, 0, 0) - Eigen::Vector3d (1, 3, 3)).norm (), 1e-12);
  ASSERT_EQ (warnings.size (), 2u);
  EXPECT_NE (warnings[0].find ("frame-000001.pose.txt"), std::string::npos);
  EXPECT_NE (warnings[1].find ("rotation"), std::string::npos);

  EXPECT_EQ (RgbdSequence (folder.path ()).size (), 3u) << "the only sequence of the scene";
  folder.text ("calibration.txt", "600 600 319.5 239.5");
  EXPECT_EQ (RgbdSequence (folder.path ("seq-01")).camera ().fx, 600.0);
  std::filesystem::create_directory (folder.path ("seq-02"));
  EXPECT_NE (messageOf<IoError> ([&] { RgbdSequence (folder.path ()); }).find (folder.path ("seq-01")),
             std::string::npos);
}

TEST (RgbdSequence, RoundedPosesAreRigidAgain)
{
  SequenceFolder folder;
  saveDepthImage (Image<float> (640, 480, 2.0f), folder.newPath ("frame-3.depth.png"));
  folder.text ("frame-3.pose.txt", "0.801 -0.6 0 1\n0.6 0.8 0.001 2\n0 0 1 3\n0 0 0 1\n");
  std::vector<std::string> warnings;
  const auto pose = RgbdSequence (folder.path ()).givenPose (0, warnings);
  ASSERT_TRUE (pose);
  EXPECT_LT ((pose->linear () * pose->linear ().transpose () - Eigen::Matrix3d::Identity ()).norm (), 1e-12);
  EXPECT_NEAR (pose->linear () (0, 0), 0.8, 2e-3);
}

TEST (RgbdSequence, ColourOfTheSameAspectIsBroughtToTheDepthsSize)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  folder.colour ("colour/Color0000.png", 7, 24, 18);
  folder.colour ("colour/Color0001.png", 7, 4, 3);
  folder.colour ("colour/Color0002.png", 7, 8, 7);
  const RgbdSequence sequence (folder.path ());
  std::vector<std::string> warnings;
  const Picture larger = sequence.read (0, warnings).colour;
  EXPECT_EQ (larger.width, 8);
  EXPECT_EQ (larger.height, 6);
  EXPECT_EQ (larger.at (2, 5)[1], 7) << "the middle of columns 6, 7 and 8";
  EXPECT_EQ (larger.at (2, 5)[2], 16);
  const Picture smaller = sequence.read (1, warnings).colour;
  EXPECT_EQ (smaller.at (2, 5)[1], 1);
  EXPECT_EQ (smaller.at (2, 5)[2], 2);
  EXPECT_TRUE (warnings.empty ());
  EXPECT_TRUE (sequence.read (2, warnings).colour.pixels.empty ());
  EXPECT_TRUE (mentions (warnings, "Color0002.png: has 8 x 7 pixels, but the depth has 8 x 6"));
}

TEST (RgbdSequence, OptionsReplaceTheCalibration)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  folder.text ("calibration.txt", "nonsense");
  SequenceSource source;
  source.intrinsics = {20.0, 21.0, 4.0, 3.0};
  const PinholeCamera camera = RgbdSequence (folder.path (), source).camera ();
  EXPECT_EQ (camera.fy, 21.0);
  EXPECT_EQ (camera.width, 8);
}

TEST (RgbdSequence, ReadsScanNetsFolders)
{
  SequenceFolder folder;
  folder.text ("intrinsic/intrinsic_depth.txt", "10 0 3.5 0\n0 11 2.5 0\n0 0 1 0\n0 0 0 1\n");
  for (const int number : {0, 1, 2})
  {
    folder.depth ("depth/" + std::to_string (number) + ".png", number);
    folder.colour ("color/" + std::to_string (number) + ".png", number);
  }
  folder.text ("pose/0.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.text ("pose/1.txt", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.camera ().fy, 11.0);
  EXPECT_TRUE (sequence.warnings ().empty ());
  std::vector<std::string> warnings;
  const std::vector<StampedPose> poses = sequence.givenTrajectory (warnings);
  ASSERT_EQ (poses.size (), 1u);
  EXPECT_LT ((poses[0].pose.translation () - Eigen::Vector3d (1, 2, 3)).norm (), 1e-12);
  ASSERT_EQ (warnings.size (), 1u); // the lost one
  EXPECT_NE (warnings[0].find ("1.txt: has a pose that is not finite"), std::string::npos);
  expectFrame (sequence, 2, 2, 1e-3);
}

TEST (RgbdSequence, ReadsReplicasFolders)
{
  SequenceFolder folder;
  folder.text ("cam_params.json", R"({"camera": {"w": 8, "h": 6, "fx": 10, "fy": 11, "cx": 3.5, "cy": 2.5,)"
                                  R"( "scale": 1000.0}})");
  std::string poses;
  for (const int number : {0, 1})
  {
    folder.depth ("room/results/depth00000" + std::to_string (number) + ".png", number);
    folder.colour ("room/results/frame00000" + std::to_string (number) + ".png", number);
    poses += "0 -1 0 " + std::to_string (number) + " 1 0 0 2 0 0 1 3 0 0 0 1\n";
  }
  folder.text ("room/traj.txt", poses);
  const RgbdSequence sequence (folder.path ("room"));
  EXPECT_EQ (sequence.camera ().fy, 11.0);
  EXPECT_EQ (sequence.depthScale (), 1000.0);
  std::vector<std::string> warnings = sequence.warnings ();
  EXPECT_EQ (sequence.givenTrajectory (warnings).at (1).pose.translation ().x (), 1.0);
  EXPECT_TRUE (warnings.empty ()) << warnings[0];
  expectFrame (sequence, 1, 1, 1e-3);

  folder.text ("room/traj.txt", poses + poses); // whose is which?
  EXPECT_TRUE (sequence.givenTrajectory (warnings).empty ());
  ASSERT_EQ (warnings.size (), 1u);
  EXPECT_NE (warnings[0].find ("has 4 poses without a stamp, but there are 2 frames"), std::string::npos);
}

TEST (RgbdSequence, AWordMayBeBehindTheNumber)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 11 3.5 2.5");
  for (const int number : {3, 4})
  {
    folder.depth ("depth/frame_000" + std::to_string (number) + "_depth.png", number);
    folder.colour ("rgb/frame_000" + std::to_string (number) + "_color.png", number);
  }
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{3, 4}));
  EXPECT_TRUE (sequence.warnings ().empty ());
  expectFrame (sequence, 1, 4, 1e-3);
}

TEST (RgbdSequence, ListsMayHaveNanoseconds)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 11 3.5 2.5");
  folder.depth ("depth/d.png", 1);
  folder.colour ("rgb/c.png", 1);
  folder.text ("associations.txt", "1305031102175304000 depth/d.png 1305031102175304000 rgb/c.png\n");
  EXPECT_NEAR (RgbdSequence (folder.path ()).stamp (0), 1305031102.175304, 1e-6);
}
