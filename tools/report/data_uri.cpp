// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "data_uri.h"

#include <pcl/cosection/common/error.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

using namespace pcl::cosection;

namespace {

constexpr int quality = 82; ///< of 100: differences cannot be seen

std::string
encoded (const cv::Mat& image)
{
  std::vector<unsigned char> bytes;
  if (!cv::imencode (".webp", image, bytes, {cv::IMWRITE_WEBP_QUALITY, quality}))
    throw IoError ("a picture cannot be encoded as WebP: this OpenCV was built without it");
  return ("data:image/webp;base64," + toBase64 (bytes.data (), bytes.size ()));
}

} // namespace

std::string
toBase64 (const void* bytes, std::size_t size)
{
  static const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* in = static_cast<const std::uint8_t*> (bytes);
  std::string text;
  text.reserve ((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3)
  {
    const std::size_t left = size - i;
    const std::uint32_t group = (static_cast<std::uint32_t> (in[i]) << 16) |
                                (left > 1 ? static_cast<std::uint32_t> (in[i + 1]) << 8 : 0) |
                                (left > 2 ? in[i + 2] : 0);
    text += letters[group >> 18];
    text += letters[(group >> 12) & 63];
    text += left > 1 ? letters[(group >> 6) & 63] : '=';
    text += left > 2 ? letters[group & 63] : '=';
  }
  return (text);
}

std::string
dataUri (const TransparentPicture& picture)
{
  const cv::Mat pixels (picture.height, picture.width, CV_8UC4,
                        const_cast<std::array<std::uint8_t, 4>*> (picture.pixels.data ()));
  cv::Mat image;
  cv::cvtColor (pixels, image, cv::COLOR_RGBA2BGRA);
  return (encoded (image));
}

std::string
dataUri (const Picture& picture)
{
  const cv::Mat pixels (picture.height, picture.width, CV_8UC3,
                        const_cast<std::array<std::uint8_t, 3>*> (picture.pixels.data ()));
  cv::Mat image;
  cv::cvtColor (pixels, image, cv::COLOR_RGB2BGR);
  return (encoded (image));
}
