// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "image_size.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace pcl::cosection {
namespace {

/** \brief Numbers in bytes; what lies beyond their end is 0, and remembered. */
class ByteReader
{
public:
  ByteReader (std::string_view bytes, bool big_endian) : bytes_ (bytes), big_endian_ (big_endian) {}

  std::uint64_t at (std::size_t place, int count)
  {
    if (place > bytes_.size () || bytes_.size () - place < static_cast<std::size_t> (count))
    {
      is_whole_ = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (int n = 0; n < count; ++n)
      value = value << 8 | static_cast<std::uint8_t> (bytes_[place + (big_endian_ ? n : count - 1 - n)]);
    return value;
  }

  bool isWhole () const { return is_whole_; }

private:
  std::string_view bytes_;
  bool big_endian_, is_whole_ = true;
};

bool
beginsWith (const std::string& bytes, std::string_view magic)
{
  return bytes.compare (0, magic.size (), magic) == 0;
}

std::optional<EncodedSize>
sizeIfWhole (const ByteReader& reader, const EncodedSize& size)
{
  return reader.isWhole () ? std::optional<EncodedSize> (size) : std::nullopt;
}

std::optional<EncodedSize>
sizeOfJpeg (const std::string& bytes)
{
  ByteReader reader (bytes, true);
  for (std::size_t place = 2; reader.isWhole ();)
  {
    if (reader.at (place, 1) != 0xff)
      return std::nullopt;
    const std::uint64_t marker = reader.at (place + 1, 1);
    const bool is_alone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
    if (marker == 0xff || is_alone) // filling, or no segment
    {
      place += marker == 0xff ? 1 : 2;
      continue;
    }
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) // a frame begins
    {
      const EncodedSize size{reader.at (place + 7, 2), reader.at (place + 5, 2)};
      return sizeIfWhole (reader, size);
    }
    place += 2 + static_cast<std::size_t> (reader.at (place + 2, 2));
  }
  return std::nullopt;
}

std::optional<EncodedSize>
sizeOfTiff (const std::string& bytes)
{
  ByteReader reader (bytes, bytes[0] == 'M');
  const auto directory = static_cast<std::size_t> (reader.at (4, 4));
  const std::uint64_t entries = reader.at (directory, 2);
  EncodedSize size;
  for (std::size_t n = 0; n < entries && reader.isWhole (); ++n)
  {
    const std::size_t entry = directory + 2 + 12 * n;
    const std::uint64_t tag = reader.at (entry, 2);
    const bool is_short = reader.at (entry + 2, 2) == 3;
    const std::uint64_t value = reader.at (entry + 8, is_short ? 2 : 4);
    if (tag == 256 || tag == 322) // of the image, of a tile
      size.width = std::max (size.width, value);
    else if (tag == 257 || tag == 323)
      size.height = std::max (size.height, value);
  }
  return sizeIfWhole (reader, size);
}

std::optional<EncodedSize>
sizeOfBmp (const std::string& bytes)
{
  ByteReader reader (bytes, false);
  if (reader.at (14, 4) == 12)
  {
    const EncodedSize size{reader.at (18, 2), reader.at (20, 2)};
    return sizeIfWhole (reader, size);
  }
  const auto length = [&] (std::size_t place) { // negative heights are of images from top to bottom
    return static_cast<std::uint64_t> (std::abs (std::int64_t{static_cast<std::int32_t> (reader.at (place, 4))}));
  };
  const EncodedSize size{length (18), length (22)};
  return sizeIfWhole (reader, size);
}

std::optional<EncodedSize>
sizeOfExr (const std::string& bytes)
{
  ByteReader reader (bytes, false);
  std::optional<EncodedSize> size;
  EncodedSize tile;
  for (std::size_t place = 8; reader.isWhole () && reader.at (place, 1) != 0;)
  {
    const std::size_t name_end = bytes.find ('\0', place);
    const std::size_t type_end = name_end == bytes.npos ? bytes.npos : bytes.find ('\0', name_end + 1);
    if (type_end == bytes.npos)
      return std::nullopt;
    const std::string_view name (bytes.data () + place, name_end - place);
    const std::size_t value = type_end + 5;
    const auto coordinate = [&] (int n) {
      return std::int64_t{static_cast<std::int32_t> (reader.at (value + 4 * static_cast<std::size_t> (n), 4))};
    };
    if (name == "dataWindow")
      size = EncodedSize{static_cast<std::uint64_t> (std::max<std::int64_t> (0, coordinate (2) - coordinate (0) + 1)),
                         static_cast<std::uint64_t> (std::max<std::int64_t> (0, coordinate (3) - coordinate (1) + 1))};
    else if (name == "tiles")
      tile = {reader.at (value, 4), reader.at (value + 4, 4)};
    place = value + static_cast<std::size_t> (reader.at (type_end + 1, 4));
  }
  if (!size || !reader.isWhole ())
    return std::nullopt;
  return EncodedSize{std::max (size->width, tile.width), std::max (size->height, tile.height)};
}

std::optional<EncodedSize>
sizeOfPnm (const std::string& bytes)
{
  constexpr std::size_t most_header = 4096;
  std::istringstream header (bytes.substr (2, most_header));
  std::uint64_t values[2] = {};
  for (std::uint64_t& value : values)
  {
    while ((header >> std::ws).peek () == '#')
      for (char c = 0; header.get (c) && c != '\n';)
        ;
    header >> value;
  }
  return header ? std::optional<EncodedSize> (EncodedSize{values[0], values[1]}) : std::nullopt;
}

} // namespace

std::optional<EncodedSize>
encodedSize (const std::string& bytes)
{
  using namespace std::string_view_literals;
  if (beginsWith (bytes, "\x89PNG\r\n\x1a\n"))
  {
    ByteReader reader (bytes, true);
    const EncodedSize size{reader.at (16, 4), reader.at (20, 4)};
    return sizeIfWhole (reader, size);
  }
  if (beginsWith (bytes, "\xff\xd8\xff"))
    return sizeOfJpeg (bytes);
  if (beginsWith (bytes, "II*\0"sv) || beginsWith (bytes, "MM\0*"sv))
    return sizeOfTiff (bytes);
  if (beginsWith (bytes, "BM"))
    return sizeOfBmp (bytes);
  if (beginsWith (bytes, "\x76\x2f\x31\x01"))
    return sizeOfExr (bytes);
  if (bytes.size () > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6')
    return sizeOfPnm (bytes);
  return std::nullopt;
}

} // namespace pcl::cosection
