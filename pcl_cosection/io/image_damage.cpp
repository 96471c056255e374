// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "image_damage.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace pcl::cosection
{

namespace
{

constexpr std::uint64_t most_pixels = std::uint64_t (1) << 27;
const char* const cut_short = "is damaged: the file is cut short";

std::uint64_t
bigEndian32 (std::string_view bytes, std::size_t at)
{
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < 4; ++n)
    value = value << 8 | static_cast<unsigned char> (bytes[at + n]);
  return value;
}

std::uint64_t
littleEndian (std::string_view bytes, std::size_t at, std::size_t size)
{
  std::uint64_t value = 0;
  for (std::size_t n = size; n-- > 0;)
    value = value << 8 | static_cast<unsigned char> (bytes[at + n]);
  return value;
}

std::string
sizeDamage (std::uint64_t width, std::uint64_t height)
{
  constexpr std::uint64_t longest = std::uint64_t (1) << 31; // the product fits
  if (width > 0 && height > 0 && width < longest && height < longest && width * height <= most_pixels)
    return {};
  return "is damaged: it says that it has " + std::to_string (width) + " x " + std::to_string (height) + " pixels";
}

/** \brief The checksum of PNG (ISO/IEC 15948, annex D). */
std::uint32_t
crc32 (std::string_view bytes)
{
  static const auto table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t n = 0; n < 256; ++n)
    {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit)
        c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      entries[n] = c;
    }
    return entries;
  }();
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes)
    crc = table[(crc ^ static_cast<unsigned char> (byte)) & 0xffu] ^ (crc >> 8);
  return crc ^ 0xffffffffu;
}

/** \brief A PNG is a signature and chunks: length, name, data, checksum of name and data. */
std::string
pngDamage (std::string_view bytes)
{
  constexpr std::size_t overhead = 12;
  for (std::size_t at = 8; at + overhead <= bytes.size ();)
  {
    const std::uint64_t length = bigEndian32 (bytes, at);
    if (length > bytes.size () - at - overhead)
      return cut_short;
    const std::string_view name_and_data = bytes.substr (at + 4, 4 + length);
    if (bigEndian32 (bytes, at + 8 + length) != crc32 (name_and_data))
      return "is damaged: a checksum does not match";
    const std::string_view name = name_and_data.substr (0, 4);
    if (name == "IHDR" && length >= 8)
    {
      const std::string damage = sizeDamage (bigEndian32 (bytes, at + 8), bigEndian32 (bytes, at + 12));
      if (!damage.empty ())
        return damage;
    }
    if (name == "IEND")
      return {};
    at += overhead + length;
  }
  return cut_short;
}

/** \brief A JPEG's scan ends with a marker of its own; thumbnails in the header do too, but before the scan begins. */
std::string
jpegDamage (std::string_view bytes)
{
  const std::size_t scan = bytes.rfind ("\xff\xda");
  const std::size_t end = bytes.rfind ("\xff\xd9");
  return scan == bytes.npos || end == bytes.npos || end < scan ? cut_short : "";
}

/** \brief What the header of an EXR says about its blocks of rows. */
struct ExrHeader
{
  std::uint64_t width = 0, height = 0;
  std::uint64_t rows_per_block = 1;
  std::size_t size = 0; ///< bytes
};

std::optional<ExrHeader>
parseExrHeader (std::string_view bytes)
{
  constexpr std::array<std::uint64_t, 10> rows_per_block = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256}; // by compression
  ExrHeader header;
  for (std::size_t at = 8; at < bytes.size ();)
  {
    if (bytes[at] == '\0')
    {
      header.size = at + 1;
      return header;
    }
    const std::size_t name_end = bytes.find ('\0', at);
    const std::size_t type_end = name_end == bytes.npos ? name_end : bytes.find ('\0', name_end + 1);
    if (type_end == bytes.npos || bytes.size () - type_end < 5)
      return std::nullopt;
    const std::string_view name = bytes.substr (at, name_end - at);
    const std::uint64_t length = littleEndian (bytes, type_end + 1, 4);
    const std::size_t value = type_end + 5;
    if (length > bytes.size () - value)
      return std::nullopt;
    if (name == "compression" && length == 1)
      header.rows_per_block = rows_per_block[std::min<std::uint64_t> (littleEndian (bytes, value, 1), 9)];
    if (name == "dataWindow" && length == 16)
    {
      std::array<std::int32_t, 4> window{}; // first column and row, last column and row
      for (std::size_t n = 0; n < 4; ++n)
        window[n] = static_cast<std::int32_t> (littleEndian (bytes, value + 4 * n, 4));
      header.width = static_cast<std::uint64_t> (std::max<std::int64_t> (0, std::int64_t (window[2]) - window[0] + 1));
      header.height = static_cast<std::uint64_t> (std::max<std::int64_t> (0, std::int64_t (window[3]) - window[1] + 1));
    }
    at = value + length;
  }
  return std::nullopt;
}

/** \brief An EXR is a header, the offsets of its blocks, and the blocks: row, length, data. */
std::string
exrDamage (std::string_view bytes)
{
  if (bytes.size () < 8)
    return cut_short;
  constexpr std::uint64_t other_kinds = 0x200 | 0x800 | 0x1000; // tiles, deep pixels, several parts
  if ((littleEndian (bytes, 4, 4) & other_kinds) != 0)
    return {};
  const std::optional<ExrHeader> header = parseExrHeader (bytes);
  if (!header)
    return cut_short;
  std::string damage = sizeDamage (header->width, header->height);
  if (!damage.empty ())
    return damage;
  const std::uint64_t blocks = (header->height + header->rows_per_block - 1) / header->rows_per_block;
  if (blocks > (bytes.size () - header->size) / 8)
    return cut_short;
  for (std::uint64_t block = 0; block < blocks; ++block)
  {
    const std::uint64_t offset = littleEndian (bytes, header->size + 8 * block, 8);
    if (offset > bytes.size () || bytes.size () - offset < 8 ||
        littleEndian (bytes, offset + 4, 4) > bytes.size () - offset - 8)
      return cut_short;
    if (offset < header->size + 8 * blocks)
      return "is damaged: it was not written to its end";
  }
  return {};
}

bool
beginsWith (const std::string& bytes, std::string_view signature)
{
  return bytes.compare (0, signature.size (), signature) == 0;
}

} // namespace

std::string
imageDamage (const std::string& bytes)
{
  if (beginsWith (bytes, "\x89PNG\r\n\x1a\n"))
    return pngDamage (bytes);
  if (beginsWith (bytes, "\xff\xd8\xff"))
    return jpegDamage (bytes);
  if (beginsWith (bytes, "\x76\x2f\x31\x01"))
    return exrDamage (bytes);
  return {};
}

} // namespace pcl::cosection
