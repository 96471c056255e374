// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_image.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/mesh/vtk_errors.h"

#include <pcl/cosection/common/error.h>

#include <boost/crc.hpp>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <string_view>

namespace pcl::cosection {
namespace {

const std::string png_signature = "\x89PNG\r\n\x1a\n";

template <typename Number>
void
copyRows (const Number* from, Image<std::uint16_t>& mask)
{
  for (int v = mask.height - 1; v >= 0; --v, from += mask.width) // VTK's first row is the lowest
    std::copy_n (from, mask.width, mask.pixels.begin () + static_cast<std::ptrdiff_t> (v) * mask.width);
}

std::uint64_t
bigEndian32 (std::string_view bytes, std::size_t at)
{
  std::uint64_t value = 0;
  for (const char byte : bytes.substr (at, 4))
    value = value << 8 | static_cast<unsigned char> (byte);
  return value;
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
  if (image->GetNumberOfScalarComponents () != 1 || (type != VTK_UNSIGNED_CHAR && type != VTK_UNSIGNED_SHORT))
    throw IoError (path + ": is not a mask: it must have one channel of 8 or 16 bits");
  Image<std::uint16_t> mask (image->GetDimensions ()[0], image->GetDimensions ()[1]);
  if (type == VTK_UNSIGNED_SHORT)
    copyRows (static_cast<const std::uint16_t*> (image->GetScalarPointer ()), mask);
  else
    copyRows (static_cast<const std::uint8_t*> (image->GetScalarPointer ()), mask);
  return mask;
}

} // namespace pcl::cosection
