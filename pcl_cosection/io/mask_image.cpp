// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_image.h"

#include "pcl_cosection/common/files.h"

#include <pcl/cosection/common/error.h>

#include <boost/crc.hpp>

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <string_view>
#include <vector>

namespace pcl::cosection {
namespace {

const std::string png_signature = "\x89PNG\r\n\x1a\n";

std::uint64_t
bigEndian32 (std::string_view bytes, std::size_t at)
{
  std::uint64_t value = 0;
  for (const char byte : bytes.substr (at, 4))
    value = value << 8 | static_cast<unsigned char> (byte);
  return value;
}

/** \brief Reads a PNG from memory, silently. libpng leaves a function that fails by a jump, which no object with a
 * destructor may be in. */
class PngReader
{
public:
  explicit PngReader (std::string_view bytes)
      : left_ (bytes)
      , png_ (png_create_read_struct (PNG_LIBPNG_VER_STRING, nullptr, onError, onWarning))
      , info_ (png_ ? png_create_info_struct (png_) : nullptr)
  {}
  PngReader (const PngReader&) = delete;
  PngReader& operator= (const PngReader&) = delete;

  ~PngReader () { png_destroy_read_struct (&png_, &info_, nullptr); }

  /** \brief false: it is no image. */
  bool readHeader ()
  {
    if (!info_ || setjmp (png_jmpbuf (png_)) != 0)
      return false;
    png_set_read_fn (png_, this, onRead);
    png_read_info (png_, info_);
    width = static_cast<int> (png_get_image_width (png_, info_));
    height = static_cast<int> (png_get_image_height (png_, info_));
    bits = png_get_bit_depth (png_, info_);
    channels = png_get_channels (png_, info_);
    png_set_packing (png_); // a byte for each number of fewer bits
    png_set_interlace_handling (png_);
    png_read_update_info (png_, info_);
    row_bytes = png_get_rowbytes (png_, info_);
    return true;
  }

  /** \brief false: it is damaged. */
  bool readRows (std::vector<png_bytep>& rows)
  {
    if (setjmp (png_jmpbuf (png_)) != 0)
      return false;
    png_read_image (png_, rows.data ());
    png_read_end (png_, nullptr);
    return true;
  }

  int width = 0, height = 0, bits = 0, channels = 0;
  std::size_t row_bytes = 0;

private:
  [[noreturn]] static void onError (png_structp png, png_const_charp) { png_longjmp (png, 1); }
  static void onWarning (png_structp, png_const_charp) {}

  static void onRead (png_structp png, png_bytep to, std::size_t size)
  {
    auto& self = *static_cast<PngReader*> (png_get_io_ptr (png));
    if (size > self.left_.size ())
      png_error (png, "cut short");
    std::copy_n (self.left_.begin (), size, to);
    self.left_.remove_prefix (size);
  }

  std::string_view left_;
  png_structp png_;
  png_infop info_;
};

/** \brief Whether the chunks of a PNG (length, name, data, checksum) are whole, and their image is not absurdly large.
 * Readers take as much memory as the first chunk claims. */
bool
isWholePng (std::string_view bytes)
{
  constexpr std::size_t overhead = 12;
  constexpr std::uint64_t most_pixels = std::uint64_t{1} << 27;
  for (std::size_t at = png_signature.size (); at + overhead <= bytes.size ();)
  {
    const std::uint64_t length = bigEndian32 (bytes, at);
    if (length > bytes.size () - at - overhead)
      return false;
    boost::crc_32_type checksum;
    checksum.process_bytes (&bytes[at + 4], 4 + length);
    const std::string_view name = bytes.substr (at + 4, 4);
    if (checksum.checksum () != bigEndian32 (bytes, at + 8 + length) ||
        (name == "IHDR" && bigEndian32 (bytes, at + 8) * bigEndian32 (bytes, at + 12) > most_pixels))
      return false;
    if (name == "IEND")
      return true;
    at += overhead + length;
  }
  return false;
}

} // namespace

bool
isDamagedPng (std::string_view bytes)
{
  return bytes.substr (0, png_signature.size ()) == png_signature && !isWholePng (bytes);
}

Image<std::uint16_t>
loadMaskImage (const std::string& path)
{
  const std::string bytes = readBytes (path);
  if (bytes.compare (0, png_signature.size (), png_signature) != 0)
    throw IoError (path + (bytes.empty () ? ": is empty; it should be a PNG" : ": is not a PNG"));
  if (isDamagedPng (bytes))
    throw IoError (path + ": is damaged: the file is cut short, or a checksum does not match");
  constexpr std::size_t most_compression = 1032; // of deflate
  PngReader reader (bytes);
  if (!reader.readHeader () ||
      reader.row_bytes > most_compression * bytes.size () / static_cast<std::size_t> (reader.height))
    throw IoError (path + ": is not an image that can be read");
  std::vector<std::uint8_t> values (reader.row_bytes * static_cast<std::size_t> (reader.height));
  std::vector<png_bytep> rows;
  for (int v = 0; v < reader.height; ++v)
    rows.push_back (&values[static_cast<std::size_t> (v) * reader.row_bytes]);
  if (!reader.readRows (rows))
    throw IoError (path + ": is damaged: its pixels cannot be read");
  Image<std::uint16_t> mask (reader.width, reader.height);
  std::vector<std::size_t> transparent; // pixels
  for (int v = 0; v < mask.height; ++v)
    for (int u = 0; u < mask.width; ++u)
    {
      const auto number = [&] (int channel) -> std::uint16_t {
        const std::size_t n = static_cast<std::size_t> (u) * reader.channels + channel;
        return reader.bits == 16 ? static_cast<std::uint16_t> (rows[v][2 * n] << 8 | rows[v][2 * n + 1]) : rows[v][n];
      };
      if (reader.channels > 2 && (number (0) != number (1) || number (0) != number (2)))
        throw IoError (path + ": is not a mask: its channels differ; it must have one channel of 8 or 16 bits, or a "
                              "palette, whose numbers are those of instances");
      mask.at (u, v) = number (0);
      const bool has_alpha = reader.channels == 2 || reader.channels == 4;
      if (has_alpha && number (reader.channels - 1) == 0)
        transparent.push_back (static_cast<std::size_t> (v) * mask.width + u);
    }
  if (transparent.size () < mask.pixels.size ()) // else its alpha channel tells nothing
    for (const std::size_t n : transparent)
      mask.pixels[n] = 0;
  return mask;
}

} // namespace pcl::cosection
