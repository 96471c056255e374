// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a colour and as a depth image of a sequence; PNGs also with chunks that are whole.

#include "fuzz_target.h"
#include "memory_file.h"
#include "seeds/image_seeds.h"
#include "seeds/mask_seeds.h"

#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/io/image_size.h"

#include <pcl/cosection/common/error.h>

#include <cmath>
#include <iostream>

using namespace pcl::cosection;

namespace {

/** \brief While it lives, OpenCV says nothing about what it cannot decode; libraries below it still do. */
class SilentErrors
{
public:
  SilentErrors () : buffer_ (std::cerr.rdbuf (nullptr)) {}
  SilentErrors (const SilentErrors&) = delete;
  SilentErrors& operator= (const SilentErrors&) = delete;
  ~SilentErrors ()
  {
    std::cerr.rdbuf (buffer_);
    std::cerr.clear ();
  }

private:
  std::streambuf* buffer_;
};

template <typename Pixel>
void
check (const Image<Pixel>& image, const std::string& bytes)
{
  fuzz::require (image.width > 0 && image.height > 0, "an image has pixels");
  const std::size_t pixels = std::size_t (image.width) * image.height;
  fuzz::require (image.pixels.size () == pixels, "a value for every pixel");
  const std::optional<EncodedSize> size = encodedSize (bytes);
  fuzz::require (size && pixels <= size->width * size->height, "an image is no larger than its header says");
}

/** \brief Whether one of the readers accepts it. */
bool
loads (const std::string& bytes)
{
  static fuzz::MemoryFile file;
  file.set (bytes);
  bool accepted = false;
  const SilentErrors silent;
  try
  {
    check (loadColourImage (file.path ()), bytes);
    accepted = true;
  }
  catch (const IoError& error) // and no other
  {
    fuzz::requireMessage (error.what ());
  }
  try
  {
    const Image<float> depth = loadDepthImage (file.path ());
    check (depth, bytes);
    for (const float z : depth.pixels)
      fuzz::require (std::isnan (z) || (z > 0.0f && std::isfinite (z)), "depths are positive or missing");
    accepted = true;
  }
  catch (const IoError& error)
  {
    fuzz::requireMessage (error.what ());
  }
  return (accepted);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  std::vector<std::string> seeds = imageSeeds ();
  for (std::string& mask : maskSeeds ()) // colour images, too
    if (mask.rfind ("abc") == std::string::npos)
      seeds.push_back (std::move (mask));
  return (seeds);
}

std::vector<std::string>
fuzz::dictionary ()
{
  using namespace std::string_literals;
  return {"\x89PNG\r\n\x1a\n",
          "IHDR",
          "PLTE",
          "IDAT",
          "tRNS",
          "\xff\xd8\xff\xe0",
          "\xff\xc0",
          "\xff\xc2",
          "\xff\xc4",
          "\xff\xdb",
          "\xff\xda",
          "\xff\xd9",
          "\xff\xe1",
          "II*\0"s,
          "MM\0*"s,
          "\0\1\3\0"s,
          "\1\1\4\0"s,
          "\2\1\3\0"s,
          "\x42\1\3\0\1\0\0\0"s,
          "BM",
          "\x28\0\0\0"s,
          "\x0c\0\0\0"s,
          "\1\0\0\0"s,
          "\x76\x2f\x31\1\2\0\0\0"s,
          "channels\0chlist\0"s,
          "compression\0compression\0\1\0\0\0"s,
          "dataWindow\0box2i\0\x10\0\0\0"s,
          "tiles\0tiledesc\0\x09\0\0\0"s,
          "B\0\2\0\0\0"s,
          "P1",
          "P3",
          "P6",
          "#"};
}

bool
fuzz::accepts (const std::string& input)
{
  const bool is_image = loads (input);
  return (input.rfind ("\x89PNG", 0) == 0 ? loads (withWholeChunks (input)) || is_image : is_image);
}
