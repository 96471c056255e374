// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// OBJ files are read by hand, because faces are a small part of the format and vtkOBJReader reads no bytes from memory.

#include "mesh_decoders.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {
namespace {

/** \brief A line; those that end with a backslash continue on the next one. */
std::string
wholeLine (TextScanner& scanner)
{
  std::string line;
  for (;;)
  {
    line += scanner.line ();
    if (!line.empty () && line.back () == '\r')
      line.pop_back ();
    if (line.empty () || line.back () != '\\' || scanner.left ().empty ())
      return line;
    line.back () = ' ';
  }
}

/** \brief The vertex of a corner "v", "v/vt", "v//vn" or "v/vt/vn", from 1, or from -1 backwards. */
std::int64_t
vertexOfCorner (std::string_view corner, std::size_t points)
{
  const std::int64_t index = toInteger (corner.substr (0, corner.find ('/')));
  return index < 0 ? static_cast<std::int64_t> (points) + index : index - 1;
}

} // namespace

PolygonSoup
decodeObj (const std::string& bytes)
{
  PolygonSoup soup;
  TextScanner scanner (bytes);
  while (!scanner.left ().empty ())
  {
    const std::string line = wholeLine (scanner);
    TextScanner words (std::string_view (line).substr (0, line.find ('#')));
    const std::string_view keyword = words.word ();
    if (keyword == "v")
    {
      Eigen::Vector3f p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = static_cast<float> (toReal (words.word ()));
      soup.points.push_back (p);
    }
    else if (keyword == "f" || keyword == "fo") // "fo": of old versions
    {
      for (std::string_view corner = words.word (); !corner.empty (); corner = words.word ())
        soup.corners.push_back (vertexOfCorner (corner, soup.points.size ()));
      soup.endPolygon ();
    }
  }
  return soup;
}

} // namespace pcl::cosection
