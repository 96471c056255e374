// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_decoders.h"
#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/file_extension.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

namespace pcl::cosection {
namespace {

using Decoder = PolygonSoup (*) (const std::string& bytes);

/** \brief The decoder of the format that a file begins as. \return nullptr if its beginning does not show the format */
Decoder
decoderForContents (const std::string& bytes)
{
  constexpr std::size_t longest = 512;
  TextScanner scanner (std::string_view (bytes).substr (0, longest));
  const std::string_view line = scanner.line ();
  const std::string_view word = TextScanner (line).word ();
  if (word == "ply")
    return decodePlyPolygons;
  if (line.rfind ("# vtk DataFile", 0) == 0)
    return decodeVtk;
  if (word == "<?xml" || word.rfind ("<VTKFile", 0) == 0)
    return decodeVtp;
  if (word == "OFF")
    return decodeOff;
  return nullptr;
}

Decoder
decoderForExtension (const std::string& extension)
{
  struct Format
  {
    const char* extension;
    Decoder decode;
  };
  static constexpr Format formats[] = {{".ply", decodePlyPolygons}, {".stl", decodeStl}, {".obj", decodeObj},
                                       {".off", decodeOff},         {".vtk", decodeVtk}, {".vtp", decodeVtp}};
  for (const Format& format : formats)
    if (extension == format.extension)
      return format.decode;
  return nullptr;
}

PolygonSoup
decode (const std::string& bytes, const std::string& extension)
{
  if (bytes.empty ())
    throw IoError ("it is empty");
  // A binary STL file may begin with anything: only its name shows the format.
  if (const Decoder decoder = (extension == ".stl" ? nullptr : decoderForContents (bytes)))
    return decoder (bytes);
  if (const Decoder decoder = decoderForExtension (extension))
    return decoder (bytes);
  throw IoError ("unknown format; known are .ply, .stl, .obj, .off, .vtk and .vtp");
}

} // namespace

TriangleMesh
loadMesh (const std::string& path)
{
  const std::string bytes = readBytes (path);
  try
  {
    return makeMesh (decode (bytes, lowerCaseExtension (path)));
  }
  catch (const IoError& error)
  {
    throw IoError ("cannot read '" + path + "': " + error.what ());
  }
}

} // namespace pcl::cosection
