// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "io/sequence_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A mask with one instance, which is all but the last column. */
void
writeMask (const SequenceFolder& folder, const std::string& name, std::uint16_t id, bool wide = false, int width = 8)
{
  Image<std::uint16_t> mask (width, 6, id);
  for (int v = 0; v < mask.height; ++v)
    mask.at (width - 1, v) = 0;
  saveMaskImage (mask, folder.newPath (name), wide);
}

} // namespace

TEST (MaskSequence, AFileForEachFrameThatHasOne)
{
  SequenceFolder folder;
  folder.coFusion ({5, 6, 7, 9});
  writeMask (folder, "mask/Mask0005.png", 200);
  writeMask (folder, "mask/Mask0007.png", 60000, true);
  writeMask (folder, "mask/Mask0008.png", 8); // the frame of this number is missing
  const RgbdSequence sequence (folder.path ());
  const MaskSequence masks (folder.path ("mask"), sequence);
  EXPECT_EQ (masks.size (), 3u);
  ASSERT_TRUE (masks.read (5));
  EXPECT_EQ (masks.read (5)->at (3, 2), 200);
  EXPECT_EQ (masks.read (7)->at (3, 2), 60000);
  EXPECT_FALSE (masks.read (6)) << "the mask of a neighbour does not count";
  EXPECT_FALSE (masks.read (9));
  EXPECT_EQ (masks.file (5), folder.path ("mask/Mask0005.png"));
  ASSERT_EQ (masks.warnings ().size (), 1u);
  EXPECT_EQ (masks.warnings ()[0], folder.path ("mask/Mask0008.png") + " matches no frame");
}

TEST (MaskSequence, NearestStampWithinHalfAPeriod)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("depth.txt", "10.00 d.png\n10.04 d.png\n10.08 d.png\n10.12 d.png\n");
  folder.depth ("d.png", 0, 5000.0);
  writeMask (folder, "mask/10.015.png", 1);
  writeMask (folder, "mask/10.061.png", 2); // nearer to 10.08
  writeMask (folder, "mask/10.145.png", 3); // too late for 10.12
  const MaskSequence masks (folder.path ("mask"), RgbdSequence (folder.path ()));
  EXPECT_EQ (masks.read (10.00)->at (0, 0), 1);
  EXPECT_FALSE (masks.read (10.04));
  EXPECT_EQ (masks.read (10.08)->at (0, 0), 2);
  EXPECT_FALSE (masks.read (10.12));
  EXPECT_TRUE (mentions (masks.warnings (), "10.145.png matches no frame"));
}

TEST (MaskSequence, BlurredMasksAreWarnedOf)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  const RgbdSequence sequence (folder.path ());
  Image<std::uint16_t> mask (sequence.camera ().width, sequence.camera ().height);
  for (std::size_t n = 0; n < mask.pixels.size (); ++n)
    mask.pixels[n] = static_cast<std::uint16_t> (n % 2 == 0 ? 0 : 5 * n);
  saveMaskImage (mask, folder.newPath ("mask/Mask0000.png"), true);
  EXPECT_TRUE (mentions (MaskSequence (folder.path ("mask"), sequence).warnings (), "masks must not be blurred"));
}

TEST (MaskSequence, ABackgroundThatIsAnInstanceIsWarnedOf)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  const RgbdSequence sequence (folder.path ());
  const auto isWarnedOf = [&] (std::uint16_t surroundings) {
    Image<std::uint16_t> mask (sequence.camera ().width, sequence.camera ().height, surroundings);
    mask.at (3, 2) = 7;
    saveMaskImage (mask, folder.newPath ("mask/Mask0000.png"), true);
    return mentions (MaskSequence (folder.path ("mask"), sequence).warnings (),
                     "if it is the background, it must be 0");
  };
  EXPECT_TRUE (isWarnedOf (255));
  EXPECT_FALSE (isWarnedOf (0));
  EXPECT_FALSE (isWarnedOf (65535)); // neither object nor background
}

TEST (MaskSequence, BadMasksAreNamed)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2, 3});
  const RgbdSequence sequence (folder.path ());
  const auto failure = [&] (const std::string& name) {
    return messageOf<IoError> ([&] { MaskSequence (folder.path (name), sequence); });
  };
  EXPECT_NE (failure ("nowhere").find ("no such folder"), std::string::npos);
  EXPECT_NE (failure ("calibration.txt").find ("is a file"), std::string::npos);
  fs::create_directory (folder.path ("mask"));
  EXPECT_NE (failure ("mask").find ("has no masks"), std::string::npos);
  writeMask (folder, "mask/Mask0100.png", 1);
  EXPECT_NE (failure ("mask").find ("no mask matches a frame; the masks have the stamps 100 to 100, the frames 0 to 3"),
             std::string::npos);

  writeMask (folder, "mask/Mask0000.png", 1, false, 9);
  folder.text ("mask/Mask0001.png", readFile (folder.path ("mask/Mask0000.png")).substr (0, 60));
  folder.colour ("mask/Mask0002.png", 0);
  folder.text ("mask/readme.png", "");
  const MaskSequence masks (folder.path ("mask"), sequence);
  EXPECT_TRUE (mentions (masks.warnings (), "readme.png: left out; a name must end in a number"));
  const auto readFailure = [&masks] (double stamp) { return messageOf<IoError> ([&] { masks.read (stamp); }); };
  EXPECT_NE (readFailure (0).find ("Mask0000.png: has 9 x 6 pixels, but the depth images have 8 x 6"),
             std::string::npos);
  EXPECT_NE (readFailure (1).find ("Mask0001.png: is damaged"), std::string::npos);
  EXPECT_NE (readFailure (2).find ("Mask0002.png: is not a mask"), std::string::npos);
  EXPECT_FALSE (masks.read (3));
}

TEST (MaskSequence, AFileForEachInstance)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  for (int frame = 0; frame < 3; ++frame)
    for (int instance = 0; instance < 2; ++instance)
    {
      Image<std::uint16_t> mask (8, 6);
      mask.at (2 * instance, 1) = mask.at (2 * instance + 1, 1) = 255;
      mask.at (7, frame) = 255; // of both
      saveMaskImage (mask, folder.newPath ("mask_visib/00000" + std::to_string (frame) + "_00000" +
                                           std::to_string (instance) + ".png"));
    }
  const RgbdSequence sequence (folder.path ());
  const MaskSequence masks (folder.path ("mask_visib"), sequence);
  EXPECT_TRUE (masks.isPerInstance ());
  EXPECT_EQ (masks.size (), 3u);
  EXPECT_EQ (masks.warnings (), std::vector<std::string> ());
  for (const double stamp : {0.0, 1.0, 2.0})
  {
    const Image<std::uint16_t> mask = *masks.read (stamp);
    EXPECT_EQ (mask.at (0, 1), 1);
    EXPECT_EQ (mask.at (3, 1), 2);
    EXPECT_EQ (mask.at (7, static_cast<int> (stamp)), 0);
    EXPECT_EQ (mask.at (5, 1), 0);
  }
}

TEST (MaskSequence, AFileForEachObjectWhoseNameBeginsWithTheObject)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2, 3});
  const auto write = [&folder] (const std::string& name, int object) {
    Image<std::uint16_t> mask (8, 6);
    mask.at (object, 2) = 255;
    saveMaskImage (mask, folder.newPath (name));
  };
  for (const std::string frame : {"0000", "0001", "0002", "0003"})
  {
    write ("numbers/3_" + frame + ".png", 0);
    write ("numbers/12_" + frame + ".png", 1);
    write ("names/carton_" + frame + ".png", 0);
    write ("names/Can-" + frame + ".png", 1);
  }
  const RgbdSequence sequence (folder.path ());
  const MaskSequence numbers (folder.path ("numbers"), sequence);
  EXPECT_TRUE (numbers.isPerInstance ());
  EXPECT_EQ (numbers.size (), 4u);
  EXPECT_EQ (numbers.read (2)->at (0, 2), 3);
  EXPECT_EQ (numbers.read (2)->at (1, 2), 12);
  EXPECT_EQ (numbers.warnings (), std::vector<std::string> ());
  const MaskSequence names (folder.path ("names"), sequence);
  EXPECT_EQ (names.read (3)->at (0, 2), 2);
  EXPECT_EQ (names.read (3)->at (1, 2), 1);
  EXPECT_TRUE (mentions (names.warnings (), "are masks of one object each, OBJECT_FRAME.png; instance 1 is can, 2 is "
                                            "carton"));

  // Masks of the first frame alone are those of a tracker that goes on by itself.
  for (const std::string object : {"1", "2", "3"})
    write ("first/" + object + "_0000.png", object[0] - '1');
  const MaskSequence first (folder.path ("first"), sequence);
  EXPECT_EQ (first.size (), 1u);
  EXPECT_EQ (first.read (0)->at (2, 2), 3);

  // Which are the masks is not known: an object is missing in a frame, or files have several instances.
  const auto failure = [&] (const std::string& name) {
    return messageOf<IoError> ([&] { MaskSequence (folder.path (name), sequence); });
  };
  fs::remove (folder.path ("numbers/3_0002.png"));
  EXPECT_NE (failure ("numbers").find ("has several masks for one frame, such as "), std::string::npos);
  Image<std::uint16_t> several (8, 6);
  several.at (0, 0) = 1;
  several.at (1, 0) = 2;
  saveMaskImage (several, folder.newPath ("names/Can-0000.png"));
  EXPECT_NE (failure ("names").find ("Can-0000.png and "), std::string::npos);
}

TEST (MaskSequence, AFolderWithoutMasksIsSaidToHoldWhatItHolds)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1});
  const auto failure = [&] (const std::string& name) {
    return messageOf<IoError> ([&] { MaskSequence (folder.path (name), RgbdSequence (folder.path ())); });
  };
  for (const std::string frame : {"0", "1"})
  {
    folder.text ("photographs/" + frame + ".JPG", "");
    folder.text ("folders/object_" + frame + "/0.png", "");
  }
  writeMask (folder, "names/0_can.png", 1);
  writeMask (folder, "names/1_car.png", 1); // of another object
  folder.text ("photographs/readme", "");
  folder.text ("photographs/.hidden", "");
  EXPECT_NE (failure ("photographs")
                 .find ("photographs: has no masks: it holds 1 other file (readme) and 2 .jpg files (0.JPG ...); masks "
                        "must be PNGs"),
             std::string::npos)
      << failure ("photographs");
  EXPECT_NE (failure ("folders").find ("it holds 2 folders (object_0 ...); masks must be PNGs in this folder"),
             std::string::npos);
  EXPECT_NE (failure ("names").find ("it holds 2 .png files (0_can.png ...); masks must be PNGs in this folder, named "
                                     "MaskNNNN.png"),
             std::string::npos);
}

TEST (MaskSequence, MasksBesideOtherImagesOfTheSameNumbersAreThoseOfThatName)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1});
  for (const std::string frame : {"0000", "0001"})
  {
    writeMask (folder, "mask/Mask" + frame + ".png", 5);
    writeMask (folder, "mask/Blend" + frame + ".png", 77);
  }
  const MaskSequence masks (folder.path ("mask"), RgbdSequence (folder.path ()));
  EXPECT_FALSE (masks.isPerInstance ());
  EXPECT_EQ (masks.read (1)->at (0, 0), 5);
  EXPECT_TRUE (mentions (masks.warnings (), "Blend0000.png and 1 more: left out; masks of the same frames are named "
                                            "MaskNNNN.png"));
}

TEST (MaskSequence, NamesOfTwoNumbersMayBeOfOneFrameEach)
{
  SequenceFolder folder;
  folder.coFusion ({3, 4});
  writeMask (folder, "mask/7_3.png", 5); // 7 is the scene's number
  writeMask (folder, "mask/7_4.png", 6);
  const MaskSequence masks (folder.path ("mask"), RgbdSequence (folder.path ()));
  EXPECT_FALSE (masks.isPerInstance ());
  EXPECT_EQ (masks.read (4)->at (0, 0), 6);
}

TEST (MaskSequence, AFileForEachInstanceBesideOtherImagesAndFramesThatAreMissing)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  for (const std::string frame : {"0", "1", "2", "3"}) // without a depth image of 3
    for (const std::string instance : {"0", "1"})
      writeMask (folder, "mask/00" + frame + "_00" + instance + ".png", 255);
  writeMask (folder, "mask/overview.png", 255);
  const MaskSequence masks (folder.path ("mask"), RgbdSequence (folder.path ()));
  EXPECT_TRUE (masks.isPerInstance ());
  EXPECT_EQ (masks.warnings (), (std::vector<std::string>{folder.path ("mask/overview.png") +
                                                              ": left out; the other names are FRAME_INSTANCE.png",
                                                          folder.path ("mask/003_000.png") + " matches no frame"}));
}

TEST (MaskSequence, ANumberBeforeThatOfTheFrameIsNoFrame)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  for (const std::string frame : {"0", "1", "2", "3"})
    writeMask (folder, "mask/cam_1_000" + frame + ".png", 5); // frame 1 is a frame, too, and 3 has no depth image
  const MaskSequence masks (folder.path ("mask"), RgbdSequence (folder.path ()));
  EXPECT_FALSE (masks.isPerInstance ());
  ASSERT_TRUE (masks.read (2));
  EXPECT_EQ (masks.read (2)->at (0, 0), 5);
}

TEST (MaskSequence, TransparentPixelsAreNoInstance)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  cv::Mat white (6, 8, CV_8UC4, cv::Scalar (255, 255, 255, 0));
  white (cv::Rect (0, 0, 4, 6)).setTo (cv::Scalar (255, 255, 255, 255));
  ASSERT_TRUE (cv::imwrite (folder.newPath ("mask/Mask0000.png"), white));
  const Image<std::uint16_t> mask = *MaskSequence (folder.path ("mask"), RgbdSequence (folder.path ())).read (0);
  EXPECT_EQ (mask.at (3, 2), 255);
  EXPECT_EQ (mask.at (4, 2), 0);
}

TEST (MaskSequence, OfAnotherResolutionAreBroughtToTheDepths)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  Image<std::uint16_t> mask (24, 18);
  for (int v = 0; v < 18; ++v)
    for (int u = 12; u < 24; ++u)
      mask.at (u, v) = 9;
  saveMaskImage (mask, folder.newPath ("mask/Mask0000.png"));
  const Image<std::uint16_t> read = *MaskSequence (folder.path ("mask"), RgbdSequence (folder.path ())).read (0);
  ASSERT_EQ (read.width, 8);
  EXPECT_EQ (read.at (3, 5), 0);
  EXPECT_EQ (read.at (4, 0), 9);
}

TEST (MaskSequence, ABandOf255BesideAllInstancesIsLeftOut)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "100 100 49.5 29.5");
  for (const int frame : {1, 2})
    folder.depth ("depth/" + std::to_string (frame) + ".png", frame, 1000.0, 100, 60);
  const auto write = [&] (const char* name, std::uint16_t other, int band_px) {
    Image<std::uint16_t> mask (100, 60, 0);
    for (int v = 10; v < 50; ++v)
      for (int u = 10; u < 50; ++u)
        mask.at (u, v) = u < 10 + band_px || v < 10 + band_px || u >= 30 ? 255 : 1;
    for (int v = 0; v < 60; ++v)
      for (int u = 30 + band_px; u < 100; ++u)
        mask.at (u, v) = u < 60 ? other : 0;
    saveMaskImage (mask, folder.newPath (name));
  };
  const RgbdSequence sequence (folder.path ());
  write ("void/0001.png", 2, 3);
  write ("void/0002.png", 2, 3);
  const MaskSequence masks (folder.path ("void"), sequence);
  ASSERT_EQ (masks.warnings ().size (), 1u);
  EXPECT_NE (masks.warnings ()[0].find ("255 is in a narrow band"), std::string::npos);
  EXPECT_EQ (masks.read (2)->at (11, 30), ignored_label);
  EXPECT_EQ (masks.read (2)->at (20, 30), 1);
  EXPECT_EQ (masks.read (2)->at (50, 30), 2);

  write ("thick/0001.png", 2, 9); // an object
  const MaskSequence thick (folder.path ("thick"), sequence);
  EXPECT_TRUE (thick.warnings ().empty ());
  EXPECT_EQ (thick.read (1)->at (11, 30), 255);
}

TEST (MaskSequence, AWordMayBeBeforeTheInstanceOrBehindTheFrame)
{
  SequenceFolder folder;
  folder.coFusion ({1, 2});
  const RgbdSequence sequence (folder.path ());
  for (const char* name : {"0001_obj1", "0001_obj4", "0002_obj1", "0002_obj4"})
    saveMaskImage (Image<std::uint16_t> (8, 6, 0), folder.newPath (std::string ("each/") + name + ".png"));
  EXPECT_TRUE (MaskSequence (folder.path ("each"), sequence).isPerInstance ());
  for (const char* name : {"frame_0001_mask", "frame_0002_mask"})
    writeMask (folder, std::string ("behind/") + name + ".png", 7);
  const MaskSequence behind (folder.path ("behind"), sequence);
  EXPECT_EQ (behind.size (), 2u);
  EXPECT_EQ (behind.read (2)->at (3, 2), 7);
}
