// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a mask in PNG: as they are, and with chunks that are whole, as damage inside them would end at checksums.

#include "fuzz_target.h"
#include "memory_file.h"
#include "seeds/mask_seeds.h"

#include "pcl_cosection/io/mask_image.h"

#include <pcl/cosection/common/error.h>

using namespace pcl::cosection;

namespace {

bool
loads (const std::string& bytes)
{
  static fuzz::MemoryFile file;
  file.set (bytes);
  Image<std::uint16_t> mask;
  try
  {
    mask = loadMaskImage (file.path ());
  }
  catch (const IoError& error) // and no other
  {
    fuzz::requireMessage (error.what ());
    return (false);
  }
  fuzz::require (mask.width > 0 && mask.height > 0, "a mask has pixels");
  fuzz::require (mask.pixels.size () == std::size_t (mask.width) * mask.height, "a label for every pixel");
  return (true);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return (maskSeeds ());
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"\x89PNG\r\n\x1a\n",
          "IHDR",
          "PLTE",
          "IDAT",
          "IEND",
          "tRNS",
          "gAMA",
          "sBIT",
          "bKGD",
          "tEXt",
          "zTXt",
          "iCCP",
          std::string ("\0\0\0\x0d", 4),
          std::string ("\0\0\0\0IEND\xae\x42\x60\x82", 12),
          std::string ("\0\0\0\6PLTE\0\0\0\x80\0\0\0\0\0\0", 18),
          std::string ("\0\0\0\1tRNS\x80\0\0\0\0", 13),
          std::string ("\xff\xff\xff\xffPLTE", 8),
          std::string ("\0\0\1\0", 4),
          std::string ("\0\0\x40\0", 4),
          "\x78\x01"};
}

bool
fuzz::accepts (const std::string& input)
{
  const bool is_mask = loads (input);
  return (loads (withWholeChunks (input)) || is_mask);
}
