// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// OFF files are read by hand, because VTK 9.1 has no reader for them.

#include "mesh_decoders.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {
namespace {

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
takeKeyword (TextScanner& words)
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

} // namespace

PolygonSoup
decodeOff (const std::string& bytes)
{
  OffLines lines (bytes);
  TextScanner header = lines.next ();
  takeKeyword (header);
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
    Eigen::Vector3f p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<float> (toReal (words.word ()));
    soup.points.push_back (p);
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

} // namespace pcl::cosection
