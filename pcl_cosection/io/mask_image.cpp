// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "mask_image.h"

#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/mesh/vtk_errors.h"

#include <pcl/cosection/common/error.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>

namespace pcl::cosection
{

namespace
{

const std::string png_signature = "\x89PNG\r\n\x1a\n";

template <typename Number>
void
copyRows (const Number* from, Image<std::uint16_t>& mask)
{
  for (int v = mask.height - 1; v >= 0; --v, from += mask.width) // VTK's first row is the lowest
    std::copy_n (from, mask.width, mask.pixels.begin () + static_cast<std::ptrdiff_t> (v) * mask.width);
}

} // namespace

Image<std::uint16_t>
loadMaskImage (const std::string& path)
{
  const std::string bytes = readBytes (path);
  if (bytes.compare (0, png_signature.size (), png_signature) != 0)
    throw IoError (path + (bytes.empty () ? ": is empty; it should be a PNG" : ": is not a PNG"));
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
