// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "image_io.h"

#include "image_size.h"
#include "lower_case.h"
#include "pcl_cosection/common/files.h"

#include <pcl/cosection/common/error.h>

#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr float largest_16_bit = 65535.0f;
constexpr std::uint64_t most_pixels = 1 << 26;  // 8192 x 8192
constexpr std::uint64_t longest_side = 1 << 15; // decoders take memory for several rows at once, however few there are

/** \brief OpenCV reads and writes EXR only if this is set before it is first asked to. */
void
allowExr ()
{
  static const bool allowed = setenv ("OPENCV_IO_ENABLE_OPENEXR", "1", 0) == 0; // once: threads may read images
  static_cast<void> (allowed);
}

void
encode (const cv::Mat& image, const std::string& path)
{
  allowExr ();
  std::vector<unsigned char> bytes;
  bool done = false;
  try
  {
    done = cv::imencode (lowerCaseExtension (path), image, bytes);
  }
  catch (const cv::Exception&)
  {
    // reported below
  }
  if (!done)
    throw IoError (path + ": cannot be encoded as an image");
  writeAtomically (path, [&bytes] (const std::string& temporary) {
    writeBytes (temporary, std::string (bytes.begin (), bytes.end ()));
  });
}

/** \brief Whether bytes begin as a JPEG does and its scan has no end: OpenCV fills what is missing of a JPEG with grey
 * and reports no error, unlike for PNG and EXR. */
bool
isCutJpeg (const std::string& bytes)
{
  if (bytes.compare (0, 3, "\xff\xd8\xff") != 0)
    return false;
  const std::size_t scan = bytes.rfind ("\xff\xda"); // thumbnails in the header have a scan, too, before it
  const std::size_t end = bytes.rfind ("\xff\xd9");
  return scan == bytes.npos || end == bytes.npos || end < scan;
}

cv::Mat
decode (const std::string& path, int flags)
{
  allowExr ();
  const std::string bytes = readBytes (path);
  if (bytes.empty ())
    throw IoError (path + ": is empty; it should be an image");
  if (bytes.size () > static_cast<std::size_t> (std::numeric_limits<int>::max ()))
    throw IoError (path + ": is too large for an image");
  if (isCutJpeg (bytes))
    throw IoError (path + ": is damaged: the file is cut short");
  if (isDamagedPng (bytes)) // on which libpng prints lines of its own
    throw IoError (path + ": is damaged: the file is cut short, or a checksum does not match");
  const std::optional<EncodedSize> size = encodedSize (bytes);
  if (!size)
    throw IoError (path + ": is not an image that can be read");
  if (size->width > longest_side || size->height > longest_side || size->width * size->height > most_pixels)
    throw IoError (path + ": is damaged: it says that it has " + std::to_string (size->width) + " x " +
                   std::to_string (size->height) + " pixels");
  cv::Mat image;
  try
  {
    image = cv::imdecode (cv::Mat (1, static_cast<int> (bytes.size ()), CV_8U, const_cast<char*> (bytes.data ())),
                          flags);
  }
  catch (const cv::Exception&)
  {
    // reported below
  }
  if (image.empty ())
    throw IoError (path + ": is not an image that can be read");
  return image;
}

/** \brief Some renderers write depth as three equal channels: one of them. Other images are returned as they are. */
cv::Mat
withoutEqualChannels (const cv::Mat& image)
{
  if (image.depth () != CV_32F || image.channels () != 3)
    return image;
  cv::Mat single (image.rows, image.cols, CV_32F);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
    {
      const cv::Vec3f& z = image.at<cv::Vec3f> (v, u);
      const bool finite = std::isfinite (z[0]) || std::isfinite (z[1]) || std::isfinite (z[2]);
      if (finite && (z[0] != z[1] || z[0] != z[2]))
        return image;
      single.at<float> (v, u) = z[0];
    }
  return single;
}

} // namespace

void
saveColourImage (const Picture& picture, const std::string& path)
{
  cv::Mat image (picture.height, picture.width, CV_8UC3);
  std::transform (picture.pixels.begin (), picture.pixels.end (), image.begin<cv::Vec3b> (),
                  [] (const auto& c) { return cv::Vec3b (c[2], c[1], c[0]); });
  encode (image, path);
}

void
saveDepthImage (const Image<float>& depth, const std::string& path, double scale)
{
  const std::string extension = lowerCaseExtension (path);
  if (extension == ".exr")
  {
    cv::Mat image (depth.height, depth.width, CV_32F);
    std::transform (depth.pixels.begin (), depth.pixels.end (), image.begin<float> (),
                    [] (float z) { return std::isfinite (z) ? z : 0.0f; });
    encode (image, path);
    return;
  }
  if (extension != ".png")
    throw InvalidArgument (path + ": depth is written as .png or .exr");
  cv::Mat image (depth.height, depth.width, CV_16U);
  std::transform (depth.pixels.begin (), depth.pixels.end (), image.begin<std::uint16_t> (), [scale] (float z) {
    const double units = std::round (scale * z);
    return static_cast<std::uint16_t> (units > 0.0 && units < largest_16_bit ? units : 0.0);
  });
  encode (image, path);
}

Image<float>
loadDepthImage (const std::string& path, double scale)
{
  const cv::Mat image = withoutEqualChannels (decode (path, cv::IMREAD_UNCHANGED));
  const bool whole = image.type () == CV_16U;
  if (!whole && image.type () != CV_32F)
    throw IoError (path + ": is not a depth image: it must have one channel of 16 bits, or of 32-bit floating point");
  Image<float> depth (image.cols, image.rows, std::numeric_limits<float>::quiet_NaN ());
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
    {
      const double z = whole ? image.at<std::uint16_t> (v, u) / scale : image.at<float> (v, u);
      const bool is_cut = whole && image.at<std::uint16_t> (v, u) == largest_16_bit; // farther, or no reading
      if (std::isfinite (z) && z > 0.0 && !is_cut)
        depth.at (u, v) = static_cast<float> (z);
    }
  return depth;
}

void
saveMaskImage (const Image<std::uint16_t>& mask, const std::string& path, bool wide)
{
  const std::uint16_t highest = mask.pixels.empty () ? 0 : *std::max_element (mask.pixels.begin (), mask.pixels.end ());
  if (!wide && highest > 255)
    throw InvalidArgument (path + ": the id " + std::to_string (highest) + " needs 16 bits");
  cv::Mat image (mask.height, mask.width, wide ? CV_16U : CV_8U);
  if (wide)
    std::copy (mask.pixels.begin (), mask.pixels.end (), image.begin<std::uint16_t> ());
  else
    std::transform (mask.pixels.begin (), mask.pixels.end (), image.begin<std::uint8_t> (),
                    [] (std::uint16_t id) { return static_cast<std::uint8_t> (id); });
  encode (image, path);
}

Picture
loadColourImage (const std::string& path)
{
  const cv::Mat image = decode (path, cv::IMREAD_COLOR);
  Picture picture (image.cols, image.rows);
  std::transform (image.begin<cv::Vec3b> (), image.end<cv::Vec3b> (), picture.pixels.begin (), [] (const cv::Vec3b& c) {
    return std::array<std::uint8_t, 3>{c[2], c[1], c[0]};
  });
  return picture;
}

} // namespace pcl::cosection
