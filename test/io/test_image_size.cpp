// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Sizes that headers of images say.

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/io/image_size.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

using namespace pcl::cosection;

TEST (EncodedSize, IsThatOfWhatOpenCvWrites)
{
  setenv ("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  for (const char* extension : {".png", ".jpg", ".tif", ".bmp", ".exr", ".ppm", ".pgm"})
  {
    const bool one_channel = std::string (extension) == ".pgm";
    const cv::Mat image (37, 53,
                         std::string (extension) == ".exr" ? CV_32FC3
                         : one_channel                     ? CV_8U
                                                           : CV_8UC3,
                         cv::Scalar (1, 2, 3));
    std::vector<unsigned char> bytes;
    ASSERT_TRUE (cv::imencode (extension, image, bytes)) << extension;
    const std::optional<EncodedSize> size = encodedSize (std::string (bytes.begin (), bytes.end ()));
    ASSERT_TRUE (size) << extension;
    EXPECT_EQ (size->width, 53u) << extension;
    EXPECT_EQ (size->height, 37u) << extension;
    for (std::size_t length = 0; length < 30; ++length) // cut short
      static_cast<void> (encodedSize (std::string (bytes.begin (), bytes.begin () + length)));
  }
  EXPECT_FALSE (encodedSize (""));
  EXPECT_FALSE (encodedSize ("text"));
}

TEST (EncodedSize, TooManyPixelsAreRefusedBeforeTheyAreDecoded)
{
  const test::TemporaryFolder folder;
  cv::Mat image (20, 20, CV_8UC3, cv::Scalar (1, 2, 3));
  std::vector<unsigned char> bytes;
  ASSERT_TRUE (cv::imencode (".bmp", image, bytes));
  bytes[18 + 2] = 9; // the width's third byte
  bytes[22 + 2] = 9;
  const std::string path = folder.file ("bomb.bmp");
  test::writeFile (path, std::string (bytes.begin (), bytes.end ()));
  const std::string message = test::messageOf<IoError> ([&] { loadColourImage (path); });
  EXPECT_NE (message.find ("is damaged: it says that it has 589844 x 589844 pixels"), std::string::npos) << message;
}

TEST (EncodedSize, TooLongRowsAreRefusedBeforeTheyAreDecoded)
{
  const test::TemporaryFolder folder;
  setenv ("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  std::vector<unsigned char> encoded;
  ASSERT_TRUE (cv::imencode (".exr", cv::Mat (9, 11, CV_32F, cv::Scalar (1)), encoded));
  std::string bytes (encoded.begin (), encoded.end ());
  const std::string window = std::string ("dataWindow\0box2i\0", 17) + std::string ("\x10\0\0\0", 4);
  const std::size_t place = bytes.find (window);
  ASSERT_NE (place, std::string::npos);
  bytes.replace (place + window.size () + 8, 8, std::string ("\x0a\0\0\1\0\0\0\0", 8)); // the last column and row
  const std::string path = folder.file ("wide.exr");
  test::writeFile (path, bytes);
  const std::string message = test::messageOf<IoError> ([&] { loadDepthImage (path); }); // 16 of its rows: a gigabyte
  EXPECT_NE (message.find ("it says that it has 16777227 x 1 pixels"), std::string::npos) << message;
}
