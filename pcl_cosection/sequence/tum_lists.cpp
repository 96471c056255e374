// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tum_lists.h"

#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/file_extension.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

constexpr double max_difference_s = 0.02; // of depth and colour, as the tool of the TUM benchmark has it
constexpr double largest_stamp_s = 1e15;
constexpr std::size_t most_neighbours = 8; // whose stamps are looked at on either side

struct StampedFile
{
  double stamp = 0.0;
  std::string name;
};

double
parseStamp (std::string_view word)
{
  const double stamp = toReal (word);
  if (!(std::abs (stamp) < largest_stamp_s))
    throw IoError (quoted (word) + " is not a time in seconds");
  return stamp;
}

/** \brief Read a list whose lines are \a columns stamped files; several columns have names without spaces. */
std::vector<std::vector<StampedFile>>
readList (const std::string& path, std::size_t columns)
{
  const std::string bytes = readBytes (path);
  std::vector<std::vector<StampedFile>> rows;
  TextScanner scanner (bytes);
  for (std::size_t number = 1; !scanner.left ().empty (); ++number)
  {
    TextScanner line (scanner.line ());
    const TextScanner whole = line;
    const std::string_view first = line.word ();
    if (first.empty () || first[0] == '#')
      continue;
    try
    {
      line = whole;
      std::vector<StampedFile> row (columns);
      for (StampedFile& file : row)
      {
        file.stamp = parseStamp (line.word ());
        file.name = line.word ();
        if (file.name.empty ())
          throw IoError ("it ends where the name of a file should be");
        if (std::any_of (file.name.begin (), file.name.end (), [] (unsigned char c) { return c < ' ' || c == 127; }))
          throw IoError (quoted (std::string_view (file.name)) + " is not the name of a file");
      }
      const std::string_view more = line.word ();
      if (!more.empty ())
        throw IoError ("there is " + quoted (more) + " behind it");
      rows.push_back (std::move (row));
    }
    catch (const IoError& error)
    {
      throw IoError (path + ": line " + std::to_string (number) + " must be " +
                     (columns == 1 ? "'stamp file'" : "'stamp file stamp file'") + ", but " + error.what ());
    }
  }
  if (rows.empty ())
    throw IoError (path + ": is empty; its lines should be " +
                   (columns == 1 ? "'stamp file'" : "'stamp file stamp file'"));
  return rows;
}

bool
contains (const std::string& name, const char* word)
{
  std::string lower (name);
  std::transform (lower.begin (), lower.end (), lower.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::tolower (c)); });
  return lower.find (word) != lower.npos;
}

/** \brief Positive if the name is that of depth, negative if it is that of colour. */
int
depthLikeness (const std::string& name)
{
  const std::string extension = lowerCaseExtension (name);
  const bool is_colour = contains (name, "rgb") || contains (name, "col");
  return 2 * contains (name, "depth") - 2 * is_colour + (extension == ".exr") -
         (extension == ".jpg" || extension == ".jpeg");
}

std::vector<FrameFiles>
readAssociations (const std::string& folder)
{
  const std::vector<std::vector<StampedFile>> rows = readList ((fs::path (folder) / "associations.txt").string (), 2);
  const bool depth_first = depthLikeness (rows[0][0].name) > depthLikeness (rows[0][1].name);
  std::vector<FrameFiles> frames;
  for (const std::vector<StampedFile>& row : rows)
  {
    const StampedFile& depth = row[depth_first ? 0 : 1];
    const StampedFile& colour = row[depth_first ? 1 : 0];
    frames.push_back (
        {depth.stamp, (fs::path (folder) / depth.name).string (), (fs::path (folder) / colour.name).string (), {}});
  }
  return frames;
}

std::vector<StampedFile>
readStampedFiles (const std::string& folder, const char* name)
{
  std::vector<StampedFile> files;
  for (std::vector<StampedFile>& row : readList ((fs::path (folder) / name).string (), 1))
    files.push_back ({row[0].stamp, (fs::path (folder) / row[0].name).string ()});
  return files;
}

/** \brief Give each frame a colour image, and no image to two frames: the pairs nearest in time first, up to
 * max_difference_s. */
void
associate (std::vector<FrameFiles>& frames, std::vector<StampedFile> colours)
{
  std::stable_sort (colours.begin (), colours.end (),
                    [] (const StampedFile& a, const StampedFile& b) { return a.stamp < b.stamp; });
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs; // difference, frame, colour
  for (std::size_t frame = 0; frame < frames.size (); ++frame)
  {
    const double stamp = frames[frame].stamp;
    const auto above = static_cast<std::size_t> (
        std::lower_bound (colours.begin (), colours.end (), stamp,
                          [] (const StampedFile& file, double s) { return file.stamp < s; }) -
        colours.begin ());
    for (std::size_t n = above - std::min (above, most_neighbours);
         n < std::min (above + most_neighbours, colours.size ()); ++n)
      if (const double difference = std::abs (colours[n].stamp - stamp); difference < max_difference_s)
        pairs.emplace_back (difference, frame, n);
  }
  std::sort (pairs.begin (), pairs.end ());
  std::vector<bool> taken (colours.size ());
  for (const auto& [difference, frame, colour] : pairs)
    if (frames[frame].colour.empty () && !taken[colour])
    {
      frames[frame].colour = colours[colour].name;
      taken[colour] = true;
    }
}

} // namespace

std::vector<FrameFiles>
readTumLists (const std::string& folder, std::vector<std::string>& warnings)
{
  std::error_code ignored;
  if (fs::exists (fs::path (folder) / "associations.txt", ignored))
    return readAssociations (folder);
  std::vector<FrameFiles> frames;
  for (StampedFile& depth : readStampedFiles (folder, "depth.txt"))
    frames.push_back ({depth.stamp, std::move (depth.name), {}, {}});
  if (fs::exists (fs::path (folder) / "rgb.txt", ignored))
    associate (frames, readStampedFiles (folder, "rgb.txt"));
  else
    warnings.push_back (folder + ": has no rgb.txt; the frames are without colour");
  return frames;
}

} // namespace pcl::cosection
