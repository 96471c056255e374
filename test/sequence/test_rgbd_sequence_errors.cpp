// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "io/sequence_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>

#include <random>

#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

std::string
failure (const std::string& path, const SequenceSource& source = {})
{
  return messageOf<IoError> ([&] { RgbdSequence (path, source); });
}

/** \brief Expect that the message names the file and has the words. */
void
expectFailure (const std::string& path, const std::string& file, const std::string& words,
               const SequenceSource& source = {})
{
  const std::string message = failure (path, source);
  EXPECT_NE (message.find (file), std::string::npos) << message;
  EXPECT_NE (message.find (words), std::string::npos) << message;
}

std::string
readFailure (const RgbdSequence& sequence, std::size_t index)
{
  std::vector<std::string> warnings;
  return messageOf<IoError> ([&] { sequence.read (index, warnings); });
}

} // namespace

TEST (RgbdSequenceErrors, WhatIsNoSequence)
{
  SequenceFolder folder;
  expectFailure (folder.path ("nowhere"), "nowhere", "no such folder");
  folder.text ("a file", "x");
  expectFailure (folder.path ("a file"), "a file", "is a file");
  expectFailure (folder.path (), folder.path (), "DepthNNNN.png");
  fs::create_directory (folder.path ("empty"));
  expectFailure (folder.path ("empty"), "empty", "is an empty folder");
  expectFailure ("", "", "no such folder");
  for (const SequenceFormat format : {SequenceFormat::CoFusion, SequenceFormat::Tum, SequenceFormat::SevenScenes})
  {
    SequenceSource source;
    source.format = format;
    expectFailure (folder.path ("empty"), folder.path ("empty"), "", source);
  }
}

TEST (RgbdSequenceErrors, DepthImagesOfAnotherFormatAreNamed)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("depth/0000.tiff", "");
  folder.text ("depth/0001.tiff", "");
  expectFailure (folder.path (), folder.path ("depth"),
                 "has no depth images: it holds 2 .tiff files (0000.tiff ...); they must be PNGs, or .exr in metres");
}

TEST (RgbdSequenceErrors, CoFusionFolders)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  SequenceSource source;
  source.depth_folder = "other";
  expectFailure (folder.path (), folder.path ("other"), "no such folder", source);
  source.depth_folder = "calibration.txt";
  expectFailure (folder.path (), "calibration.txt", "is a file", source);
  source.depth_folder = "colour"; // any name that ends in a number will do, but not any image
  std::vector<std::string> warnings;
  EXPECT_NE (messageOf<IoError> ([&] {
               RgbdSequence (folder.path (), source).read (0, warnings);
             }).find ("Color0000.png: is not a depth image"),
             std::string::npos);
  fs::remove (folder.path ("depth/Depth0000.png"));
  expectFailure (folder.path (), folder.path ("depth"), "DepthNNNN");
  fs::remove (folder.path ("depth"));
  folder.text ("depth", "a file");
  expectFailure (folder.path (), folder.path (), "");
}

TEST (RgbdSequenceErrors, OddNamesAreLeftOut)
{
  SequenceFolder folder;
  folder.coFusion ({3, 4});
  folder.text ("depth/Depth99999999999999999999999999999999.png", "");
  folder.text ("depth/Depth" + std::string (200, '9') + ".png", "");
  folder.text ("depth/Depth3.png", "");
  folder.text ("depth/Depth.png", "");
  folder.text ("depth/.Depth0001.png", "");
  folder.text ("depth/Depth-1.png", "");
  folder.text ("depth/notes 5.txt", "");
  fs::create_directory (folder.path ("depth/Depth0009.png"));
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.stamps (), (std::vector<double>{3, 4}));
  EXPECT_TRUE (mentions (sequence.warnings (), "more than 15 digits"));
  EXPECT_TRUE (mentions (sequence.warnings (), "same number"));
  EXPECT_TRUE (mentions (sequence.warnings (), "must end in a number"));
  EXPECT_EQ (sequence.files (0).depth, folder.path ("depth/Depth0003.png")) << "the first by name";
}

class BadCalibration : public testing::TestWithParam<std::pair<const char*, const char*>>
{};

TEST_P (BadCalibration, IsSaid)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  folder.text ("calibration.txt", GetParam ().first);
  expectFailure (folder.path (), folder.path ("calibration.txt"), GetParam ().second);
}

INSTANTIATE_TEST_SUITE_P (
    RgbdSequenceErrors, BadCalibration,
    testing::Values (std::pair ("", "has 0 numbers"), std::pair ("# only a comment 1 2 3 4\n", "has 0 numbers"),
                     std::pair ("10 10 4\n", "has 3 numbers"), std::pair ("10 10 4 3 8\n", "has 5 numbers"),
                     std::pair ("10 0 4 0 10 3 0 1", "has 8 numbers"),
                     std::pair ("10 0 4 0 10 3 0 1 1", "not that of a camera"),
                     std::pair ("10,10,4,3", "is not a number"), std::pair ("fx 10 10 4 3", "'fx' is not a number"),
                     std::pair ("0 10 4 3 8 6", "must be positive"), std::pair ("-10 10 4 3 8 6", "must be positive"),
                     std::pair ("nan 10 4 3 8 6", "must be positive"), std::pair ("10 inf 4 3 8 6", "must be positive"),
                     std::pair ("1e300 10 4 3", "must be positive"),
                     std::pair ("0.82 1.09 0.5 0.5 8 6", "must be in pixels"),
                     std::pair ("9000 9000 4 3 8 6", "must be in pixels"),
                     std::pair ("9000 9000 4 3", "must be in pixels"), // for the size of the first image
                     std::pair ("10 10 nan 3 8 6", "principal point"), std::pair ("10 10 4 1e6 8 6", "principal point"),
                     std::pair ("10 10 4 300 8 6", "principal point"), std::pair ("10 10 4 3 0 6", "whole numbers"),
                     std::pair ("10 10 4 3 8.5 6", "whole numbers"), std::pair ("10 10 4 3 -8 6", "whole numbers"),
                     std::pair ("10 10 4 3 1e9 6", "whole numbers"), std::pair ("10 10 4 3 nan 6", "whole numbers")));

TEST (RgbdSequenceErrors, AMissingCalibrationNamesTheOption)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  fs::remove (folder.path ("calibration.txt"));
  expectFailure (folder.path (), folder.path (), "--intrinsics");
  folder.text ("depth.txt", "0 depth/Depth0000.png\n");
  expectFailure (folder.path (), folder.path (), "--intrinsics");
  fs::create_directory (folder.path ("calibration.txt"));
  expectFailure (folder.path (), folder.path ("calibration.txt"), "is not a file");
}

class BadList : public testing::TestWithParam<std::pair<const char*, const char*>>
{};

TEST_P (BadList, NamesTheLine)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  const auto [list, words] = GetParam ();
  folder.text ("depth.txt", list);
  expectFailure (folder.path (), folder.path ("depth.txt"), words);
  const bool is_comment_or_nothing = std::string (words).find ("line") == std::string::npos;
  folder.text ("associations.txt",
               is_comment_or_nothing ? list : "0 rgb/a 0 depth/b\n0 " + std::string (list).substr (0, 4));
  expectFailure (folder.path (), folder.path ("associations.txt"), is_comment_or_nothing ? words : "line 2");
}

INSTANTIATE_TEST_SUITE_P (RgbdSequenceErrors, BadList,
                          testing::Values (std::pair ("", "is empty"), std::pair ("\n# stamp file\n\n", "is empty"),
                                           std::pair ("\n0.5\n", "line 2"), std::pair ("garbage line\n", "line 1"),
                                           std::pair ("0 a.png\nnan b.png\n", "line 2"),
                                           std::pair ("inf a.png", "line 1"), std::pair ("1e300 a.png", "line 1"),
                                           std::pair ("0 a.png b.png", "line 1"),
                                           std::pair ("\x01\xff\xfe garbage", "line 1"),
                                           std::pair ("0 a\x1b[1m.png", "line 1")));

TEST (RgbdSequenceErrors, TextsOfAnyBytesAreReadOrTold)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  const std::vector<std::pair<std::string, std::string>> texts = {
      {"calibration.txt", "10 10.5 +4 3e0 8 6\n# camera\n"},
      {"depth.txt", "# stamp file\n0.5 depth/Depth0000.png\n1.5 depth/Depth0000.png\n"},
      {"rgb.txt", "0.5 colour/Color0000.png\n1.5 colour/Color0000.png\n"},
      {"associations.txt", "0.5 rgb/0.png 0.5 depth/Depth0000.png\n1.5 rgb/0.png 1.5 depth/Depth0000.png\n"}};
  const std::string alphabet ("0123456789.e+-# \n\r\t/\0\x7f\xff\x1bnaif", 28);
  std::mt19937 random (1);
  std::size_t read = 0, told = 0;
  for (const auto& [name, text] : texts)
  {
    for (int n = 0; n < 150; ++n)
    {
      std::string bytes = text;
      for (std::size_t change = random () % 3 + 1; change > 0; --change)
        if (random () % 2 != 0)
          bytes[random () % bytes.size ()] = alphabet[random () % alphabet.size ()];
        else
          bytes.insert (random () % bytes.size (), 1 + random () % 20, alphabet[random () % alphabet.size ()]);
      folder.text (name, bytes);
      try
      {
        const RgbdSequence sequence (folder.path ());
        ++read;
        EXPECT_GT (sequence.size (), 0u);
        EXPECT_NO_THROW (sequence.camera ().validate ());
        EXPECT_GT (sequence.period (), 0.0);
        for (std::size_t i = 0; i < sequence.size (); ++i)
          EXPECT_TRUE (std::isfinite (sequence.stamp (i)) && (i == 0 || sequence.stamp (i - 1) < sequence.stamp (i)));
      }
      catch (const IoError& error)
      {
        ++told;
        for (const unsigned char c : std::string (error.what ()))
          EXPECT_TRUE (c >= ' ' && c != 127) << error.what ();
      }
    }
    folder.text (name, text);
  }
  EXPECT_GT (read, 30u);
  EXPECT_GT (told, 30u);
}

TEST (RgbdSequenceErrors, DamagedFramesAreErrorsOfTheirOwn)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2, 3, 4, 5});
  testing::internal::CaptureStderr ();
  folder.text ("depth/Depth0001.png", readFile (folder.path ("depth/Depth0000.png")).substr (0, 70));
  folder.depth ("depth/Depth0002.png", 2, 1000.0, 4, 6);
  saveColourImage (Picture (8, 6), folder.path ("depth/Depth0003.png"));
  const RgbdSequence sequence (folder.path ());
  fs::remove (folder.path ("depth/Depth0004.png"));
  fs::remove (folder.path ("depth/Depth0005.png"));
  ASSERT_EQ (mkfifo (folder.path ("depth/Depth0005.png").c_str (), 0600), 0); // reading it would wait forever
  EXPECT_NE (readFailure (sequence, 1).find ("Depth0001.png: is damaged"), std::string::npos);
  EXPECT_NE (readFailure (sequence, 2).find ("Depth0002.png: has 4 x 6 pixels, but"), std::string::npos);
  EXPECT_NE (readFailure (sequence, 2).find ("calibration.txt has 8 x 6 pixels"), std::string::npos);
  EXPECT_NE (readFailure (sequence, 3).find ("Depth0003.png: is not a depth image"), std::string::npos);
  EXPECT_NE (readFailure (sequence, 4).find ("Depth0004.png: there is no such file"), std::string::npos);
  EXPECT_NE (readFailure (sequence, 5).find ("Depth0005.png: is not a file"), std::string::npos);
  std::vector<std::string> warnings;
  EXPECT_EQ (sequence.read (0, warnings).stamp, 0.0);
  EXPECT_THROW (sequence.read (6, warnings), InvalidArgument);
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "");
}

TEST (RgbdSequenceErrors, DamagedColourLeavesTheDepth)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  folder.text ("colour/Color0000.png", "no image");
  const RgbdSequence sequence (folder.path ());
  fs::remove (folder.path ("colour/Color0001.png"));
  std::vector<std::string> warnings;
  for (std::size_t n = 0; n < 2; ++n)
  {
    const RgbdFrame frame = sequence.read (n, warnings);
    EXPECT_EQ (frame.depth.width, 8);
    EXPECT_TRUE (frame.colour.pixels.empty ());
  }
  ASSERT_EQ (warnings.size (), 2u);
  EXPECT_NE (warnings[0].find ("Color0000.png"), std::string::npos);
  EXPECT_NE (warnings[1].find ("Color0001.png"), std::string::npos);
}

TEST (RgbdSequenceErrors, TheSizeIsThatOfTheFirstDepthThatCanBeRead)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  folder.text ("calibration.txt", "10 10 4 3");
  folder.text ("depth/Depth0000.png", "no image");
  folder.depth ("depth/Depth0002.png", 2, 1000.0, 4, 3);
  const RgbdSequence sequence (folder.path ());
  EXPECT_EQ (sequence.camera ().width, 8);
  EXPECT_NE (readFailure (sequence, 2).find ("Depth0001.png has 8 x 6 pixels"), std::string::npos);
  folder.text ("depth/Depth0001.png", "no image");
  folder.text ("depth/Depth0002.png", "no image");
  expectFailure (folder.path (), "Depth0000.png", "no depth image can be read");
}

TEST (RgbdSequenceErrors, WrongUnitsAreTold)
{
  SequenceFolder folder;
  folder.coFusion ({0, 1, 2});
  const auto warningsWith = [&folder] (double scale) {
    SequenceSource source;
    source.depth_scale = scale;
    std::vector<std::string> warnings;
    RgbdSequence (folder.path (), source).read (1, warnings);
    return warnings;
  };
  EXPECT_TRUE (warningsWith (1000.0).empty ());
  EXPECT_TRUE (warningsWith (5000.0).empty ());
  EXPECT_TRUE (mentions (warningsWith (1.0), "--depth-scale"));
  EXPECT_TRUE (mentions (warningsWith (1e6), "--depth-scale"));

  Image<float> millimetres (8, 6, 1500.0f), nothing (8, 6, std::numeric_limits<float>::quiet_NaN ());
  fs::remove (folder.path ("depth/Depth0000.png"));
  saveDepthImage (millimetres, folder.path ("depth/Depth0000.exr"));
  saveDepthImage (nothing, folder.path ("depth/Depth0001.png"));
  const RgbdSequence sequence (folder.path ());
  std::vector<std::string> warnings;
  sequence.read (0, warnings);
  EXPECT_TRUE (
      mentions (warnings, "Depth0000.exr: half of the depths are more than 1500 m; an .exr must be in metres"));
  sequence.read (1, warnings);
  EXPECT_TRUE (mentions (warnings, "Depth0001.png: has no depth in any pixel"));
}

TEST (RgbdSequenceErrors, MillimetresInTheLayoutOfTumAreTold)
{
  SequenceFolder folder;
  folder.text ("calibration.txt", "10 10 3.5 2.5 8 6");
  folder.text ("associations.txt", "1.0 rgb/0.png 1.0 depth/0.png\n");
  folder.colour ("rgb/0.png", 0);
  folder.depth ("depth/0.png", 0, 1000.0);
  saveDepthImage (Image<float> (8, 6, 0.9f), folder.path ("depth/0.png"));
  for (const double scale : {0.0, 1000.0})
  {
    SequenceSource source;
    source.depth_scale = scale;
    std::vector<std::string> warnings;
    RgbdSequence (folder.path (), source).read (0, warnings);
    EXPECT_EQ (mentions (warnings, "half of the depths are less than 0.18 m; give --depth-scale"), scale == 0.0);
  }
}

TEST (RgbdSequenceErrors, OptionsOutsideTheirDomain)
{
  SequenceFolder folder;
  folder.coFusion ({0});
  for (const double scale : {-1.0, std::numeric_limits<double>::infinity (), std::numeric_limits<double>::quiet_NaN ()})
  {
    SequenceSource source;
    source.depth_scale = scale;
    EXPECT_NE (messageOf<InvalidArgument> ([&] { RgbdSequence (folder.path (), source); }).find ("depth_scale"),
               std::string::npos);
  }
  const double bad_intrinsics[][4] = {{0, 10, 4, 3}, {10, -1, 4, 3}, {10, 10, NAN, 3}, {9000, 10, 4, 3}};
  for (const auto& bad : bad_intrinsics)
  {
    SequenceSource source;
    source.intrinsics = {bad[0], bad[1], bad[2], bad[3]};
    EXPECT_NE (messageOf<InvalidArgument> ([&] { RgbdSequence (folder.path (), source); }).find ("intrinsics"),
               std::string::npos);
  }
}

TEST (RgbdSequenceErrors, WhatMustNotBeRead)
{
  if (geteuid () == 0)
    GTEST_SKIP () << "root reads everything";
  SequenceFolder folder;
  folder.coFusion ({0});
  fs::permissions (folder.path ("depth/Depth0000.png"), fs::perms::none);
  EXPECT_NE (readFailure (RgbdSequence (folder.path ()), 0).find ("Permission"), std::string::npos);
  fs::permissions (folder.path ("calibration.txt"), fs::perms::none);
  expectFailure (folder.path (), folder.path ("calibration.txt"), "Permission");
  fs::permissions (folder.path ("depth"), fs::perms::none);
  expectFailure (folder.path (), folder.path ("depth"), "Permission");
  fs::permissions (folder.path ("depth"), fs::perms::owner_all);
}
