// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_image.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/mesh/vtk_errors.h"

#include <pcl/cosection/common/error.h>

#include <boost/crc.hpp>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <array>
#include <map>
#include <string_view>

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

/** \brief Calls value (pixel), with the channels of each, for the mask. */
template <typename Number, typename Value>
void
copyRows (const Number* from, int channels, Image<std::uint16_t>& mask, Value&& value)
{
  for (int v = mask.height - 1; v >= 0; --v) // VTK's first row is the lowest
    for (int u = 0; u < mask.width; ++u, from += channels)
      mask.at (u, v) = value (from);
}

/** \brief Numbers of the colours of a palette, which vtkPNGReader replaces by these; empty if the PNG has none. Of
 * equal colours the first counts. */
std::map<std::array<std::uint8_t, 3>, std::uint16_t>
paletteOf (std::string_view bytes)
{
  constexpr std::size_t colour_type = 25, header = 33; // places: of a byte of IHDR, and behind it
  constexpr std::size_t overhead = 12;
  std::map<std::array<std::uint8_t, 3>, std::uint16_t> numbers;
  if (bytes.size () < header || bytes[colour_type] != 3)
    return numbers;
  for (std::size_t at = header; at + overhead <= bytes.size ();)
  {
    const std::uint64_t length = bigEndian32 (bytes, at);
    if (bytes.substr (at + 4, 4) == "PLTE")
      for (std::uint16_t n = 0; 3u * n + 3 <= length; ++n)
      {
        std::array<std::uint8_t, 3> colour;
        for (std::size_t channel = 0; channel < 3; ++channel)
          colour[channel] = static_cast<std::uint8_t> (bytes[at + 8 + 3 * n + channel]);
        numbers.emplace (colour, n);
      }
    at += overhead + length;
  }
  return numbers;
}

/** \brief Read one channel, several that are equal, or the numbers of a palette; alpha is not used. */
template <typename Number>
void
copyMask (const std::string& path, const std::string& bytes, const Number* from, int channels,
          Image<std::uint16_t>& mask)
{
  const auto palette = paletteOf (bytes);
  copyRows (from, channels, mask, [&] (const Number* pixel) -> std::uint16_t {
    if (channels < 3)
      return pixel[0];
    if (!palette.empty ())
    {
      const auto found = palette.find ({static_cast<std::uint8_t> (pixel[0]), static_cast<std::uint8_t> (pixel[1]),
                                        static_cast<std::uint8_t> (pixel[2])});
      return found == palette.end () ? std::uint16_t{0} : found->second;
    }
    if (pixel[0] != pixel[1] || pixel[0] != pixel[2])
      throw IoError (path + ": is not a mask: its channels differ; it must have one channel of 8 or 16 bits, or a "
                            "palette, whose numbers are those of instances");
    return pixel[0];
  });
}

/** \brief Whether the chunks of a PNG (length, name, data, checksum) are whole, and their image is not absurdly large.
 * vtkPNGReader crashes where libpng reports an error, and takes as much memory as the first chunk claims. */
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
  vtkNew<vtkPNGReader> reader;
  const auto errors = VtkErrors::observe (*reader);
  reader->SetMemoryBuffer (bytes.data ());
  reader->SetMemoryBufferLength (static_cast<vtkIdType> (bytes.size ()));
  reader->Update ();
  vtkImageData* const image = reader->GetOutput ();
  const int type = image->GetScalarType ();
  if (errors->failed () || image->GetNumberOfPoints () == 0)
    throw IoError (path + ": is not an image that can be read");
  if (type != VTK_UNSIGNED_CHAR && type != VTK_UNSIGNED_SHORT)
    throw IoError (path + ": is not a mask: it must have channels of 8 or 16 bits");
  const int channels = image->GetNumberOfScalarComponents ();
  Image<std::uint16_t> mask (image->GetDimensions ()[0], image->GetDimensions ()[1]);
  if (type == VTK_UNSIGNED_SHORT)
    copyMask (path, bytes, static_cast<const std::uint16_t*> (image->GetScalarPointer ()), channels, mask);
  else
    copyMask (path, bytes, static_cast<const std::uint8_t*> (image->GetScalarPointer ()), channels, mask);
  return mask;
}

} // namespace pcl::cosection
