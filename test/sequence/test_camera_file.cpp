// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Cameras and frames as other programs write them.

#include "common/message_of.h"
#include "io/sequence_folder.h"

#include "pcl_cosection/sequence/camera_file.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

void
expectCamera (const PinholeCamera& camera, const std::array<double, 4>& intrinsics)
{
  EXPECT_DOUBLE_EQ (camera.fx, intrinsics[0]);
  EXPECT_DOUBLE_EQ (camera.fy, intrinsics[1]);
  EXPECT_DOUBLE_EQ (camera.cx, intrinsics[2]);
  EXPECT_DOUBLE_EQ (camera.cy, intrinsics[3]);
}

/** \brief Frames in rgb/ and depth/, with this file of a camera. */
void
writeFrames (const std::string& name, const std::string& camera, const SequenceFolder& folder)
{
  folder.depth ("depth/000000.png", 0);
  folder.colour ("rgb/000000.png", 0);
  folder.text (name, camera);
}

const std::string bop = R"({"cam_K": [10, 0, 3.5, 0, 11, 2.5, 0, 0, 1], "depth_scale": 0.1})";

} // namespace

TEST (CameraFile, IsReadInTheFormsOfOthers)
{
  const std::array<double, 4> expected = {10, 11, 3.5, 2.5};
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"cam_K.txt", "10 0 3.5\n0 11 2.5\n0 0 1\n"},
           {"camera-intrinsics.txt", "10 0 3.5\n0 11 2.5\n0 0 1\n"},
           {"intrinsic_depth.txt", "10 0 3.5 0\n0 11 2.5 0\n0 0 1 0\n0 0 0 1\n"},
           {"camera_intrinsic.json",
            R"({"width": 8, "height": 6, "intrinsic_matrix": [10, 0, 0, 0, 11, 0, 3.5, 2.5, 1]})"},
           {"scene_camera.json", "{\"0\": " + bop + ", \"1\": " + bop + "}"},
           {"camera.json", R"({"fx": 10, "fy": 11, "cx": 3.5, "cy": 2.5, "width": 8, "height": 6})"},
           {"intrinsics.json", R"({"fx": 10, "fy": 11, "ppx": 3.5, "ppy": 2.5, "width": 8, "height": 6})"}})
  {
    const SequenceFolder folder;
    writeFrames (name, content, folder);
    const RgbdSequence sequence (folder.path ());
    expectCamera (sequence.camera (), expected);
    EXPECT_EQ (sequence.camera ().width, 8) << name;
    EXPECT_EQ (sequence.depthScale (), name == "scene_camera.json" ? 10000.0 : 1000.0);
    EXPECT_FALSE (sequence.files (0).colour.empty ()) << "the colour images are in rgb/";
    EXPECT_EQ (sequence.warnings (), std::vector<std::string> ());
  }
}

TEST (CameraFile, ScalesOfTheDepthInTheUnitsOfOthers)
{
  const std::string fields = R"("fx": 10, "fy": 11, "cx": 3.5, "cy": 2.5, "depth_scale": )";
  for (const auto& [content, units_per_metre] : std::vector<std::pair<std::string, double>>{
           {"{" + fields + "0.1}", 10000.0},  // BOP: a unit in millimetres
           {"{" + fields + "0.001}", 1000.0}, // librealsense: in metres
           {"{" + fields + "0.0001}", 10000.0},
           {R"({"intrinsic_matrix": [10, 0, 0, 0, 11, 0, 3.5, 2.5, 1], "depth_scale": 1000.0})", 1000.0}}) // Open3D
  {
    const SequenceFolder folder;
    writeFrames ("camera.json", content, folder);
    EXPECT_NEAR (RgbdSequence (folder.path ()).depthScale (), units_per_metre, 1e-6) << content;
  }
}

TEST (CameraFile, BadOnesAreNamed)
{
  for (const auto& [name, content, reason] : std::vector<std::array<std::string, 3>>{
           {"cam_K.txt", "10 2 3.5 0 11 2.5 0 0 1", "not that of a camera"},
           {"cam_K.txt", "10 0 3.5 0 11", "has 5 numbers"},
           {"calibration.txt", "10 11 3.5 2.5 0.1 -0.2 0.001 0.002 0",
            "if they are 'fx fy cx cy' and distortion, undistort the images and give the four numbers alone"},
           {"scene_camera.json", "{}", "holds no camera"},
           {"scene_camera.json", "[1]", "holds no camera"},
           {"scene_camera.json", "{\"0\": {\"cam_K\": [1, 2]}}", "there must be 9"},
           {"scene_camera.json", "{\"0\": {\"cam_K\": \"x\"}}", "is not the JSON of a camera"},
           {"scene_camera.json", "{\"0\": " + bop + ", \"1\": {\"cam_K\": [9, 0, 3.5, 0, 11, 2.5, 0, 0, 1]}}",
            "different cameras"},
           {"camera.json", R"({"fx": 10, "fy": 11, "cx": 3.5})", "is not the JSON of a camera"},
           {"camera.json", R"({"fx": 10, "fy": 11, "cx": 3.5, "cy": 2.5, "depth_scale": -1})", "not positive"},
           {"camera_intrinsic.json", "{\"width\": 8", "is not the JSON of a camera"}})
  {
    const SequenceFolder folder;
    writeFrames (name, content, folder);
    const std::string message = messageOf<IoError> ([&] { RgbdSequence (folder.path ()); });
    EXPECT_NE (message.find (name), std::string::npos) << message;
    EXPECT_NE (message.find (reason), std::string::npos) << message;
  }
}

TEST (CameraFile, MayBeNestedDeeply)
{
  const std::string brackets (300000, '[');
  const SequenceFolder folder;
  writeFrames ("scene_camera.json", "{\"0\": {\"cam_K\": " + brackets + std::string (300000, ']') + "}}", folder);
  EXPECT_NE (messageOf<IoError> ([&] { RgbdSequence (folder.path ()); }).find ("is not the JSON of a camera"),
             std::string::npos);
}

TEST (CameraFile, OfAnotherResolutionIsScaled)
{
  const auto write = [] (const std::string& camera, const SequenceFolder& folder) {
    folder.depth ("depth/Depth0000.png", 0, 1000.0, 80, 60);
    folder.colour ("colour/Color0000.png", 0, 240, 180);
    folder.text ("calibration.txt", camera);
  };
  const std::array<double, 4> expected = {70, 70, 39.5, 29.5};
  for (const std::string camera : {"210 210 119.5 89.5", "210 210 119.5 89.5 240 180"})
  {
    const SequenceFolder folder;
    write (camera, folder);
    const RgbdSequence sequence (folder.path ());
    expectCamera (sequence.camera (), expected);
    ASSERT_EQ (sequence.warnings ().size (), 1u);
    EXPECT_NE (sequence.warnings ()[0].find ("240 x 180 pixels; it is scaled to the 80 x 60 pixels"),
               std::string::npos);
    std::vector<std::string> warnings;
    EXPECT_EQ (sequence.read (0, warnings).depth.width, 80);
  }
  SequenceFolder hardly_larger; // its camera is 0.24 of the width off the middle of the depth images
  hardly_larger.depth ("depth/Depth0000.png", 0, 1000.0, 80, 60);
  hardly_larger.colour ("colour/Color0000.png", 0, 120, 90);
  hardly_larger.text ("calibration.txt", "105 105 59 44.5");
  expectCamera (RgbdSequence (hardly_larger.path ()).camera (), {70, 70, 59.5 / 1.5 - 0.5, 29.5});
  const SequenceFolder right, impossible, half, corner;
  write ("70 70 39.5 29.5", right);
  write ("35 35 19.5 14.5", half); // of 40 x 30: may have been cut out
  ASSERT_EQ (RgbdSequence (half.path ()).warnings ().size (), 1u);
  EXPECT_NE (RgbdSequence (half.path ()).warnings ()[0].find ("far from the middle of the depth images of 80 x 60"),
             std::string::npos);
  corner.depth ("depth/Depth0000.png", 0, 1000.0, 80, 60);
  corner.text ("calibration.txt", "140 140 79.5 59.5"); // of 160 x 120
  EXPECT_NE (messageOf<IoError> ([&] { RgbdSequence (corner.path ()); }).find ("outside the depth images of 80 x 60"),
             std::string::npos);
  write ("70 70 100 29.5", impossible); // the middle of neither
  EXPECT_EQ (RgbdSequence (right.path ()).warnings (), std::vector<std::string> ());
  SequenceSource source;
  source.intrinsics = {210, 210, 119.5, 89.5};
  expectCamera (RgbdSequence (right.path (), source).camera (), expected);

  EXPECT_NE (
      messageOf<IoError> ([&] { RgbdSequence (impossible.path ()); }).find ("outside the depth images of 80 x 60"),
      std::string::npos);
  source.intrinsics = {70, 70, 100, 29.5}; // of an image that was cut out: the user says so
  EXPECT_EQ (RgbdSequence (right.path (), source).camera ().cx, 100.0);
}

TEST (FrameNames, MayBeTimesInNanoseconds)
{
  SequenceFolder folder;
  folder.text ("cam_K.txt", "10 0 3.5\n0 11 2.5\n0 0 1\n");
  for (int frame = 0; frame < 3; ++frame)
  {
    const std::string name = std::to_string (1581120424166928768 + 33333333LL * frame) + ".png";
    folder.depth ("depth/" + name, frame);
    folder.colour ("rgb/" + name, frame);
    saveMaskImage (Image<std::uint16_t> (8, 6, 255), folder.newPath ("masks/" + name));
  }
  const RgbdSequence sequence (folder.path ());
  ASSERT_EQ (sequence.size (), 3u);
  EXPECT_NEAR (sequence.stamp (0), 1581120424.166928, 1e-5);
  EXPECT_FALSE (sequence.files (2).colour.empty ());
  EXPECT_EQ (MaskSequence (folder.path ("masks"), sequence).read (sequence.stamp (1))->at (0, 0), 255);
}

TEST (FrameNames, OfTwoClocksAreAssociated)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 11 3.5 2.5 8 6\n");
  for (int frame = 0; frame < 3; ++frame)
  {
    folder.depth ("depth/41048190_10." + std::to_string (frame) + "00.png", frame);
    folder.colour ("color/41048190_10." + std::to_string (frame) + "07.png", frame);
  }
  const RgbdSequence sequence (folder.path ());
  ASSERT_EQ (sequence.size (), 3u);
  EXPECT_DOUBLE_EQ (sequence.stamp (1), 10.1);
  for (int frame = 0; frame < 3; ++frame)
    EXPECT_NE (sequence.files (frame).colour.find ("10." + std::to_string (frame) + "07"), std::string::npos);
}
