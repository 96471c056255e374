// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "image_seeds.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdlib>

namespace fuzz {
namespace {

/** \brief A plane that slants, with a hole, in the units of its type. */
cv::Mat
image (int type)
{
  const double unit = CV_MAT_DEPTH (type) == CV_32F ? 0.05 : CV_MAT_DEPTH (type) == CV_16U ? 50.0 : 1.0;
  cv::Mat pixels (9, 11, type);
  for (int v = 0; v < pixels.rows; ++v)
    for (int u = 0; u < pixels.cols; ++u)
      pixels (cv::Rect (u, v, 1, 1)).setTo (cv::Scalar::all (unit * (20 + 3 * u + 2 * v)));
  pixels (cv::Rect (3, 2, 2, 4)).setTo (cv::Scalar::all (0.0));
  return (pixels);
}

std::string
encoded (const char* extension, int type, const std::vector<int>& parameters = {})
{
  std::vector<unsigned char> bytes;
  cv::imencode (extension, image (type), bytes, parameters);
  return {bytes.begin (), bytes.end ()};
}

} // namespace

std::vector<std::string>
imageSeeds ()
{
  using namespace std::string_literals;
  setenv ("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  constexpr int tiff_plain = 1, tiff_lzw = 5, tiff_deflate = 8;
  std::vector<std::string> seeds = {
      encoded (".png", CV_8UC3),
      encoded (".png", CV_16UC1),
      encoded (".jpg", CV_8UC3),
      encoded (".jpg", CV_8UC1),
      encoded (".jpg", CV_8UC3, {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 1}),
      encoded (".bmp", CV_8UC3),
      encoded (".bmp", CV_8UC1),
      encoded (".bmp", CV_8UC4),
      encoded (".tif", CV_8UC3, {cv::IMWRITE_TIFF_COMPRESSION, tiff_lzw}),
      encoded (".tif", CV_16UC1, {cv::IMWRITE_TIFF_COMPRESSION, tiff_deflate}),
      encoded (".tif", CV_32FC1, {cv::IMWRITE_TIFF_COMPRESSION, tiff_plain}),
      encoded (".ppm", CV_8UC3),
      encoded (".pgm", CV_16UC1),
      encoded (".exr", CV_32FC1),
      encoded (".exr", CV_32FC3),
      encoded (".exr", CV_32FC1, {cv::IMWRITE_EXR_TYPE, cv::IMWRITE_EXR_TYPE_HALF}),
      "P1\n# a comment\n3 2\n0 1 0\n1 0 1\n",
      "P2\n3 2\n1000\n0 10 200\n1000 0 7\n",
      "P3 2 1 255\n1 2 3 255 254 0\n",
      "P4\n9 2\n\x80\x80\x7f\0"s};
  return (seeds);
}

} // namespace fuzz
