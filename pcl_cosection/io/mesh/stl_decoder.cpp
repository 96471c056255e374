// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// STL files are read by hand, because the format is smaller than the checks that vtkSTLReader would need around it.

#include "mesh_decoders.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace pcl::cosection {
namespace {

constexpr std::size_t header_size = 84; // title and number of triangles
constexpr std::size_t title_size = 80;
constexpr std::size_t triangle_size = 50; // normal, corners, two unused bytes

std::string
lowerCase (std::string_view word)
{
  std::string lower (word);
  std::transform (lower.begin (), lower.end (), lower.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::tolower (c)); });
  return lower;
}

std::size_t
countOfBinary (const std::string& bytes)
{
  std::uint32_t count = 0;
  std::memcpy (&count, bytes.data () + title_size, sizeof (count));
  return count;
}

/** \brief Titles of binary files may begin with "solid" too, so the size decides where it can. */
bool
isText (const std::string& bytes)
{
  if (bytes.size () >= header_size && bytes.size () == header_size + triangle_size * countOfBinary (bytes))
    return false;
  return lowerCase (TextScanner (bytes).word ()) == "solid" && bytes.find ('\0') == std::string::npos;
}

PolygonSoup
decodeText (const std::string& bytes)
{
  PolygonSoup soup;
  TextScanner scanner (bytes);
  bool in_solid = false;
  for (std::string_view raw = scanner.word (); !raw.empty (); raw = scanner.word ())
  {
    const std::string word = lowerCase (raw);
    if (word == "solid" || word == "endsolid")
    {
      in_solid = (word == "solid");
      scanner.line (); // its name, of any words
    }
    else if (word == "vertex")
    {
      Eigen::Vector3f p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = static_cast<float> (toReal (scanner.word ()));
      soup.corners.push_back (static_cast<std::int64_t> (soup.points.size ()));
      soup.points.push_back (p);
    }
    else if (word == "endloop")
      soup.endPolygon ();
    else if (word == "facet")
      scanner.line (); // its normal, which follows from the corners
    else if (word != "outer" && word != "loop" && word != "endfacet")
      throw IoError (quoted (raw) + " is not a word of an STL file");
  }
  if (in_solid)
    throw IoError ("the STL file ends before its 'endsolid'");
  return soup;
}

PolygonSoup
decodeBinary (const std::string& bytes)
{
  if (bytes.size () < header_size)
    throw IoError ("it is neither a text that begins with 'solid' nor as long as the header of a binary STL file");
  const std::size_t count = countOfBinary (bytes);
  if (bytes.size () < header_size + triangle_size * count)
    throw IoError ("the STL file is shorter than its " + std::to_string (count) + " triangles");
  PolygonSoup soup;
  soup.points.resize (3 * count);
  for (std::size_t n = 0; n < soup.points.size (); ++n)
  {
    const std::size_t place = header_size + triangle_size * (n / 3) + sizeof (float) * 3 * (1 + n % 3);
    std::memcpy (soup.points[n].data (), bytes.data () + place, 3 * sizeof (float));
    soup.corners.push_back (static_cast<std::int64_t> (n));
    if (n % 3 == 2)
      soup.endPolygon ();
  }
  return soup;
}

} // namespace

PolygonSoup
decodeStl (const std::string& bytes)
{
  return isText (bytes) ? decodeText (bytes) : decodeBinary (bytes);
}

} // namespace pcl::cosection
