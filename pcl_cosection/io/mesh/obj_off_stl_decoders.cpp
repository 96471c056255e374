// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// OBJ files are read by hand, because faces are a small part of the format and vtkOBJReader reads no bytes from memory;
// OFF files, because VTK 9.1 has no reader for them; STL files, because the format is smaller than the checks that
// vtkSTLReader would need around it.

#include "mesh_decoders.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <cstring>

namespace pcl::cosection {
namespace {

/** \brief The next three words as coordinates. */
Eigen::Vector3d
nextPoint (TextScanner& words)
{
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = toReal (words.word ());
  return p;
}

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

/** \brief The lines of an OFF file that are not empty, without comments. */
class OffLines
{
public:
  explicit OffLines (std::string_view text) : text_ (text) {}

  TextScanner next ()
  {
    while (!text_.left ().empty ())
    {
      const std::string_view line = text_.line ();
      const TextScanner words (line.substr (0, line.find ('#')));
      if (!TextScanner (words).word ().empty ())
        return words;
    }
    throw IoError ("the OFF file is shorter than its header says");
  }

  std::size_t left () const { return text_.left ().size (); }

private:
  TextScanner text_;
};

/** \brief Checks the keyword [ST][C][N][4][n]OFF and takes it from \a words; files without one are OFF too. */
void
takeOffKeyword (TextScanner& words)
{
  const std::string_view line = words.left ();
  const std::size_t off = line.find ("OFF");
  if (off == line.npos)
    return;
  const std::string_view prefix = line.substr (0, off);
  if (prefix.find_first_of ("4n") != prefix.npos)
    throw IoError ("the vertices of " + quoted (line.substr (0, off + 3)) + " are not of three dimensions");
  words = TextScanner (line.substr (off + 3)); // the counts may follow, even without a space
  if (TextScanner (words).word () == "BINARY")
    throw IoError ("binary OFF files are not supported");
}

constexpr std::size_t stl_header_size = 84; // title and number of triangles
constexpr std::size_t stl_title_size = 80;
constexpr std::size_t stl_triangle_size = 50; // normal, corners, two unused bytes

std::size_t
stlCount (const std::string& bytes)
{
  std::uint32_t count = 0;
  std::memcpy (&count, bytes.data () + stl_title_size, sizeof (count));
  return count;
}

/** \brief Titles of binary files may begin with "solid" too, so the size decides where it can. */
bool
isStlText (const std::string& bytes)
{
  if (bytes.size () >= stl_header_size && bytes.size () == stl_header_size + stl_triangle_size * stlCount (bytes))
    return false;
  return lowerCase (TextScanner (bytes).word ()) == "solid" && bytes.find ('\0') == std::string::npos;
}

PolygonSoup
decodeStlText (const std::string& bytes)
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
      soup.corners.push_back (static_cast<std::int64_t> (soup.points.size ()));
      soup.points.push_back (nextPoint (scanner));
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
decodeStlBinary (const std::string& bytes)
{
  if (bytes.size () < stl_header_size)
    throw IoError ("it is neither a text that begins with 'solid' nor as long as the header of a binary STL file");
  const std::size_t count = stlCount (bytes);
  if (bytes.size () < stl_header_size + stl_triangle_size * count)
    throw IoError ("the STL file is shorter than its " + std::to_string (count) + " triangles");
  PolygonSoup soup;
  soup.points.resize (3 * count);
  for (std::size_t n = 0; n < soup.points.size (); ++n)
  {
    const std::size_t place = stl_header_size + stl_triangle_size * (n / 3) + sizeof (float) * 3 * (1 + n % 3);
    Eigen::Vector3f point;
    std::memcpy (point.data (), bytes.data () + place, 3 * sizeof (float));
    soup.points[n] = point.cast<double> ();
    soup.corners.push_back (static_cast<std::int64_t> (n));
    if (n % 3 == 2)
      soup.endPolygon ();
  }
  return soup;
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
      soup.points.push_back (nextPoint (words));
    else if (keyword == "f" || keyword == "fo") // "fo": of old versions
    {
      for (std::string_view corner = words.word (); !corner.empty (); corner = words.word ())
        soup.corners.push_back (vertexOfCorner (corner, soup.points.size ()));
      soup.endPolygon ();
    }
  }
  return soup;
}

PolygonSoup
decodeOff (const std::string& bytes)
{
  OffLines lines (bytes);
  TextScanner header = lines.next ();
  takeOffKeyword (header);
  std::string_view word = header.word ();
  if (word.empty ())
  {
    header = lines.next ();
    word = header.word ();
  }
  const std::int64_t points = toInteger (word);
  const std::int64_t faces = toInteger (header.word ());
  // A vertex takes six characters at least ("0 0 0" and the line's end) and a face two.
  const auto left = static_cast<std::int64_t> (lines.left ()) + 1;
  if (points < 0 || faces < 0 || points > left / 6 || faces > left / 2)
    throw IoError ("the OFF file is shorter than its header says");

  PolygonSoup soup;
  for (std::int64_t n = 0; n < points; ++n)
  {
    TextScanner words = lines.next ();
    soup.points.push_back (nextPoint (words));
  }
  for (std::int64_t n = 0; n < faces; ++n)
  {
    TextScanner words = lines.next ();
    for (std::int64_t corners = toInteger (words.word ()); corners > 0; --corners)
      soup.corners.push_back (toInteger (words.word ()));
    soup.endPolygon ();
  }
  return soup;
}

PolygonSoup
decodeStl (const std::string& bytes)
{
  return isStlText (bytes) ? decodeStlText (bytes) : decodeStlBinary (bytes);
}

} // namespace pcl::cosection
