// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_seeds.h"

#include <boost/crc.hpp>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstdint>

namespace fuzz {
namespace {

const std::string signature = "\x89PNG\r\n\x1a\n";

std::string
bigEndian (std::uint32_t value, int bytes)
{
  std::string result;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    result += static_cast<char> (value >> shift);
  return (result);
}

std::string
chunk (const std::string& name, const std::string& data)
{
  boost::crc_32_type checksum;
  checksum.process_bytes (name.data (), name.size ());
  checksum.process_bytes (data.data (), data.size ());
  return (bigEndian (static_cast<std::uint32_t> (data.size ()), 4) + name + data + bigEndian (checksum.checksum (), 4));
}

/** \brief As zlib wraps bytes that it does not compress. */
std::string
stored (const std::string& bytes)
{
  constexpr std::uint32_t modulus = 65521; // of Adler-32
  std::uint32_t low = 1, high = 0;
  for (const char byte : bytes)
  {
    low = (low + static_cast<unsigned char> (byte)) % modulus;
    high = (high + low) % modulus;
  }
  const auto size = static_cast<std::uint16_t> (bytes.size ());
  const auto inverse = static_cast<std::uint16_t> (~size);
  std::string block = "\x78\x01\x01";
  for (const std::uint16_t number : {size, inverse})
  {
    block += static_cast<char> (number);
    block += static_cast<char> (number >> 8);
  }
  return (block + bytes + bigEndian (high, 2) + bigEndian (low, 2));
}

enum class ColourType
{
  Grey = 0,
  Colour = 2,
  Palette = 3,
  GreyAndAlpha = 4,
};

/** \brief A PNG that no library writes for masks. */
struct Png
{
  std::uint32_t width, height;
  char bits;
  ColourType colour_type;
  std::string rows;   ///< with a filter before each
  std::string chunks; ///< between header and rows
  bool interlaced = false;
};

std::string
written (const Png& png)
{
  const char end[] = {png.bits, static_cast<char> (png.colour_type), 0, 0, png.interlaced};
  const std::string header = bigEndian (png.width, 4) + bigEndian (png.height, 4) + std::string (end, sizeof (end));
  return (signature + chunk ("IHDR", header) + png.chunks + chunk ("IDAT", stored (png.rows)) + chunk ("IEND", ""));
}

std::string
repeated (const std::string& row, std::size_t times)
{
  std::string rows;
  for (std::size_t n = 0; n < times; ++n)
    rows += row;
  return (rows);
}

/** \brief Two instances, 1 and the largest number, on 0. */
std::string
encoded (int type)
{
  cv::Mat mask (6, 7, type, cv::Scalar::all (0));
  mask (cv::Rect (1, 1, 2, 4)).setTo (cv::Scalar::all (1));
  mask (cv::Rect (4, 2, 3, 3)).setTo (cv::Scalar::all (CV_MAT_DEPTH (type) == CV_8U ? 255 : 65535));
  std::vector<unsigned char> bytes;
  cv::imencode (".png", mask, bytes);
  return {bytes.begin (), bytes.end ()};
}

} // namespace

std::vector<std::string>
maskSeeds ()
{
  std::vector<std::string> seeds;
  for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_16UC3, CV_8UC4, CV_16UC4})
    seeds.push_back (encoded (type));
  const std::string palette = chunk ("PLTE", std::string ("\0\0\0\x80\0\0\0\x80\0\x80\x80\0", 12)); // as of PASCAL VOC
  const std::string opacities = chunk ("tRNS", "\xff\x80");
  const std::string text = chunk ("tEXt", std::string ("Comment\0a mask", 14));
  const std::string row ("\0\0\1\2\3\1", 6);
  seeds.push_back (written ({5, 3, 8, ColourType::Palette, repeated (row, 3), palette}));
  seeds.push_back (written ({5, 3, 8, ColourType::Palette, repeated (row, 3), text + palette + opacities}));
  seeds.push_back (written ({4, 2, 4, ColourType::Palette, repeated (std::string ("\0\x01\x23", 3), 2), palette}));
  seeds.push_back (written ({4, 2, 2, ColourType::Palette, repeated ("\1\x1b", 2), palette}));
  seeds.push_back (written ({8, 2, 1, ColourType::Grey, repeated (std::string ("\0\x5a", 2), 2), ""}));
  seeds.push_back (written ({2, 2, 4, ColourType::Grey, repeated ("\2\x13", 2), ""}));
  seeds.push_back (written ({2, 2, 8, ColourType::GreyAndAlpha, repeated ("\4\1\xff\2\x80", 2), ""}));
  seeds.push_back (written ({1, 2, 16, ColourType::GreyAndAlpha, repeated ("\3\1\1\xff\xff", 2), text}));
  seeds.push_back (written ({2, 2, 8, ColourType::Grey, std::string ("\0\1\0\2\0\3\4", 7), "", true}));
  seeds.push_back (written ({5, 3, 8, ColourType::Palette, repeated (row, 3), palette}) + chunk ("PLTE", "abc"));
  return (seeds);
}

std::string
withWholeChunks (const std::string& png)
{
  constexpr std::size_t overhead = 12;
  std::string whole = signature;
  for (std::size_t at = signature.size (); at + overhead <= png.size ();)
  {
    std::size_t length = 0;
    for (std::size_t n = 0; n < 4; ++n)
      length = length << 8 | static_cast<unsigned char> (png[at + n]);
    length = std::min (length, png.size () - at - overhead);
    whole += chunk (png.substr (at + 4, 4), png.substr (at + 8, length));
    at += overhead + length;
  }
  return (whole + chunk ("IEND", ""));
}

} // namespace fuzz
