// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sequence_layouts.h"

#include "numbered_files.h"
#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/lower_case.h"
#include "stamp_matching.h"
#include "stamped_list.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

const NumberedNames co_fusion_depth = {{"depth", ""}, {".exr", ".png"}};
const NumberedNames co_fusion_colour = {{"color", "colour", "rgb", ""},
                                        {".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".tif", ".tiff"}};
const NumberedNames replica_colour = {{"frame"}, co_fusion_colour.endings};
const NumberedNames co_fusion_pose = {{""}, {".txt"}};
const NumberedNames seven_scenes_depth = {{"frame-"}, {".depth.png", ".depth.exr"}};
const NumberedNames seven_scenes_colour = {{"frame-"}, {".color.png", ".color.jpg", ".color.jpeg"}};
const NumberedNames seven_scenes_pose = {{"frame-"}, {".pose.txt"}};

const std::vector<std::string> depth_folders = {"depth_noise", "depth", "results"}; // the last one of Replica's scenes

constexpr double max_difference_s = 0.02;  // of depth and colour, as the tool of the TUM benchmark has it
constexpr std::size_t most_neighbours = 8; // whose stamps are looked at on either side

constexpr double gap_periods = 1.5;

std::string
inFolder (const std::string& folder, const std::string& name)
{
  return (fs::path (folder) / name).string ();
}

bool
isFolder (const std::string& path)
{
  std::error_code ignored;
  return fs::is_directory (path, ignored);
}

bool
isThere (const std::string& path)
{
  std::error_code ignored;
  return fs::exists (path, ignored);
}

std::map<double, std::string>
byNumber (const std::vector<NumberedFile>& files)
{
  std::map<double, std::string> paths;
  for (const NumberedFile& file : files)
    paths[file.number] = file.path;
  return paths;
}

/** \brief The frames whose colour and pose have the number of a depth image. */
std::vector<FrameFiles>
joinByNumber (const std::vector<NumberedFile>& depth, const std::vector<NumberedFile>& colour,
              const std::vector<NumberedFile>& pose)
{
  auto colour_paths = byNumber (colour), pose_paths = byNumber (pose); // "" for other numbers
  std::vector<FrameFiles> files;
  for (const NumberedFile& file : depth)
    files.push_back ({file.number, file.path, colour_paths[file.number], pose_paths[file.number]});
  return files;
}

/** \brief Warn of colour images whose number no depth image has: they are no frames. */
void
warnOfMissingDepth (const std::vector<NumberedFile>& depth, const std::vector<NumberedFile>& colour,
                    std::vector<std::string>& warnings)
{
  const auto depth_paths = byNumber (depth);
  std::vector<std::string> without;
  for (const NumberedFile& file : colour)
    if (depth_paths.count (file.number) == 0)
      without.push_back (file.path);
  if (!without.empty ())
    warnings.push_back (firstAndMore (without) + ": no depth image has the same number; there are " +
                        std::to_string (colour.size ()) + " colour images and " + std::to_string (depth.size ()) +
                        " depth images");
}

/** \brief The first of these folders in a folder; empty if there is none. */
std::string
firstFolder (const std::string& folder, const std::vector<std::string>& names)
{
  for (const std::string& name : names)
    if (const std::string path = inFolder (folder, name); isFolder (path))
      return path;
  return {};
}

/** \brief The depth images of the folder asked for, else of depth_noise, else of depth, else of results. */
std::vector<NumberedFile>
coFusionDepth (const std::string& folder, const std::string& asked, std::vector<std::string>& warnings)
{
  const std::vector<std::string> choices = asked.empty () ? depth_folders : std::vector{asked};
  for (const std::string& choice : choices)
  {
    const std::string path = inFolder (folder, choice);
    if (asked.empty () && !isThere (path))
      continue;
    std::vector<NumberedFile> depth = numberedImages (path, co_fusion_depth, warnings);
    if (!depth.empty ())
      return depth;
    if (choice != "depth_noise" || !asked.empty () || !isThere (inFolder (folder, "depth")))
      throw IoError (path + ": has no depth images: it " + contentsOf (path) +
                     "; they must be PNGs, or .exr in metres, whose names end in a number, as DepthNNNN.png");
  }
  throw IoError (folder + ": has no folder depth_noise or depth; another one can be given with --depth-dir");
}

void
listSevenScenes (SequenceListing& listing)
{
  const std::string& folder = listing.folder;
  const std::vector<std::string> names = fileNames (folder);
  const std::vector<NumberedFile> depth = numberedFiles (folder, names, seven_scenes_depth, listing.warnings);
  if (depth.empty ())
    throw IoError (folder + ": has no depth images; their names should be frame-NNNNNN.depth.png");
  const std::vector<NumberedFile> colour = numberedFiles (folder, names, seven_scenes_colour, listing.warnings);
  listing.files = joinByNumber (depth, colour, numberedFiles (folder, names, seven_scenes_pose, listing.warnings));
  warnOfMissingDepth (depth, colour, listing.warnings);
}

/** \brief Positive if the name is that of depth, negative if it is that of colour. */
int
depthLikeness (const std::string& name)
{
  const auto contains = [lower = lowerCase (name)] (const char* word) { return lower.find (word) != lower.npos; };
  const std::string extension = lowerCaseExtension (name);
  const bool is_colour = contains ("rgb") || contains ("col");
  return 2 * contains ("depth") - 2 * is_colour + (extension == ".exr") - (extension == ".jpg" || extension == ".jpeg");
}

/** \brief The list that associates depth and colour, which benchmarks and tools call associations.txt, associate.txt
 * and the like; empty if there is none. */
std::string
associationFile (const std::string& folder)
{
  const std::vector<std::string> names = fileNames (folder);
  auto found = std::find (names.begin (), names.end (), "associations.txt");
  if (found == names.end ())
    found = std::find_if (names.begin (), names.end (), [] (const std::string& name) {
      return lowerCase (name).rfind ("assoc", 0) == 0 && lowerCaseExtension (name) == ".txt";
    });
  return found == names.end () ? std::string () : inFolder (folder, *found);
}

std::vector<FrameFiles>
readAssociations (const std::string& path, const std::string& folder)
{
  const std::vector<std::vector<StampedFile>> rows = readStampedList (path, 2);
  const bool depth_first = depthLikeness (rows[0][0].name) > depthLikeness (rows[0][1].name);
  std::vector<FrameFiles> frames;
  for (const std::vector<StampedFile>& row : rows)
  {
    const StampedFile& depth = row[depth_first ? 0 : 1];
    const StampedFile& colour = row[depth_first ? 1 : 0];
    frames.push_back ({depth.stamp, inFolder (folder, depth.name), inFolder (folder, colour.name), {}});
  }
  return frames;
}

std::vector<StampedFile>
readStampedFiles (const std::string& folder, const char* name)
{
  std::vector<StampedFile> files;
  for (std::vector<StampedFile>& row : readStampedList (inFolder (folder, name), 1))
    files.push_back ({row[0].stamp, inFolder (folder, row[0].name)});
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

/** \brief Whether numbers have fractions, as times in seconds have. */
bool
isTime (const std::vector<NumberedFile>& files)
{
  return std::any_of (files.begin (), files.end (),
                      [] (const NumberedFile& file) { return file.number != std::floor (file.number); });
}

void
listCoFusion (const SequenceSource& source, SequenceListing& listing)
{
  const std::vector<NumberedFile> depth = coFusionDepth (listing.folder, source.depth_folder, listing.warnings);
  std::vector<NumberedFile> colour, poses;
  for (const char* name : {"colour", "color", "rgb"})
    if (const std::string path = inFolder (listing.folder, name); colour.empty () && isFolder (path))
      colour = numberedImages (path, co_fusion_colour, listing.warnings);
  if (const fs::path path = fs::path (depth.front ().path).parent_path ();
      colour.empty () && path.filename () == depth_folders.back ())
    colour = numberedFiles (path.string (), fileNames (path.string ()), replica_colour, listing.warnings);
  if (const std::string path = firstFolder (listing.folder, {"pose", "poses"}); !path.empty ())
    poses = numberedFiles (path, fileNames (path), co_fusion_pose, listing.warnings);
  if (const std::string path = inFolder (listing.folder, "traj.txt"); poses.empty () && isThere (path))
    listing.trajectory = path;
  listing.files = joinByNumber (depth, colour, poses);
  const auto without = std::count_if (listing.files.begin (), listing.files.end (),
                                      [] (const FrameFiles& files) { return files.colour.empty (); });
  const bool differ = 2 * static_cast<std::size_t> (without) > listing.files.size ();
  if (!differ || !isTime (depth) || !isTime (colour))
    return warnOfMissingDepth (depth, colour, listing.warnings);
  std::vector<StampedFile> stamped; // of two cameras, that are not triggered together
  for (const NumberedFile& file : colour)
    stamped.push_back ({file.number, file.path});
  associate (listing.files, stamped);
}

/** \brief The frames of TUM's layout, in the order of the lists; depth may be without colour. \throws IoError */
std::vector<FrameFiles>
readTumLists (const std::string& folder, std::vector<std::string>& warnings)
{
  if (const std::string list = associationFile (folder); !list.empty ())
    return readAssociations (list, folder);
  std::vector<FrameFiles> frames;
  for (StampedFile& depth : readStampedFiles (folder, "depth.txt"))
    frames.push_back ({depth.stamp, std::move (depth.name), {}, {}});
  if (isThere (inFolder (folder, "rgb.txt")))
    associate (frames, readStampedFiles (folder, "rgb.txt"));
  else
    warnings.push_back (folder + ": has no rgb.txt; the frames are without colour");
  return frames;
}

bool
hasSevenScenesFrames (const std::string& folder)
{
  std::vector<std::string> ignored;
  return !numberedFiles (folder, fileNames (folder), seven_scenes_depth, ignored).empty ();
}

/** \brief The folder seq-NN of a scene of 7-Scenes that has only one; the folder itself if it has no such folder.
 * \throws IoError if there are several */
std::string
sevenScenesFolder (const std::string& folder)
{
  if (hasSevenScenesFrames (folder))
    return folder;
  std::set<std::string> sequences;
  std::error_code failure;
  for (fs::directory_iterator entry (folder, failure); !failure && entry != fs::directory_iterator ();
       entry.increment (failure))
    if (entry->path ().filename ().string ().rfind ("seq-", 0) == 0 && isFolder (entry->path ().string ()))
      sequences.insert (entry->path ().string ());
  if (sequences.size () > 1)
    throw IoError (folder + ": has " + std::to_string (sequences.size ()) + " sequences; give one of them, such as " +
                   *sequences.begin ());
  return sequences.empty () ? folder : *sequences.begin ();
}

SequenceFormat
detectFormat (const std::string& folder, const SequenceSource& source)
{
  if (hasSevenScenesFrames (folder))
    return SequenceFormat::SevenScenes;
  if (!associationFile (folder).empty () || isThere (inFolder (folder, "depth.txt")) ||
      isThere (inFolder (folder, "rgb.txt")))
    return SequenceFormat::Tum;
  if (!source.depth_folder.empty () || !firstFolder (folder, depth_folders).empty ())
    return SequenceFormat::CoFusion;
  if (sevenScenesFolder (folder) != folder)
    return SequenceFormat::SevenScenes;
  std::error_code ignored;
  if (fs::is_empty (folder, ignored))
    throw IoError (folder + ": is an empty folder");
  throw IoError (folder +
                 ": holds no sequence that is known; there should be depth_noise/ or depth/ with DepthNNNN.png or "
                 ".exr (Co-Fusion), associations.txt or depth.txt (TUM), or frame-NNNNNN.depth.png (7-Scenes)");
}

/** \brief Sort by stamps and leave out what comes twice. */
void
sortFiles (SequenceListing& listing)
{
  const auto earlier = [] (const FrameFiles& a, const FrameFiles& b) { return a.stamp < b.stamp; };
  if (!std::is_sorted (listing.files.begin (), listing.files.end (), earlier))
  {
    listing.warnings.push_back (listing.folder + ": the stamps do not ascend; the frames are sorted");
    std::stable_sort (listing.files.begin (), listing.files.end (), earlier);
  }
  std::vector<FrameFiles> unique;
  std::vector<std::string> again;
  for (FrameFiles& files : listing.files)
    if (!unique.empty () && unique.back ().stamp == files.stamp)
      again.push_back (files.depth);
    else
      unique.push_back (std::move (files));
  if (!again.empty ())
    listing.warnings.push_back (firstAndMore (again) + ": left out; another frame has the same stamp");
  listing.files = std::move (unique);
}

void
warnOfMissingColour (SequenceListing& listing)
{
  std::vector<std::string> without;
  for (const FrameFiles& files : listing.files)
    if (files.colour.empty ())
      without.push_back (files.depth);
  if (!without.empty ())
    listing.warnings.push_back (firstAndMore (without) + (without.size () == 1 ? " has" : " have") +
                                " no colour image");
}

void
warnOfGaps (SequenceListing& listing)
{
  std::vector<double> stamps;
  for (const FrameFiles& files : listing.files)
    stamps.push_back (files.stamp);
  const double period = stampPeriod (stamps);
  std::vector<std::string> gaps;
  for (std::size_t n = 1; n < stamps.size (); ++n)
    if (stamps[n] - stamps[n - 1] > gap_periods * period)
      gaps.push_back (listing.files[n - 1].depth);
  if (!gaps.empty ())
    listing.warnings.push_back (listing.folder + ": frames are missing after " + firstAndMore (gaps));
}

} // namespace

SequenceListing
listSequence (const std::string& folder, const SequenceSource& source)
{
  fileNames (folder); // throws if it is not a folder
  SequenceListing listing;
  listing.folder = folder;
  listing.format = source.format == SequenceFormat::Detect ? detectFormat (folder, source) : source.format;
  if (listing.format == SequenceFormat::SevenScenes)
  {
    listing.folder = sevenScenesFolder (folder);
    listSevenScenes (listing);
  }
  else if (listing.format == SequenceFormat::Tum)
    listing.files = readTumLists (folder, listing.warnings);
  else
    listCoFusion (source, listing);
  sortFiles (listing);
  warnOfMissingColour (listing);
  warnOfGaps (listing);
  return listing;
}

} // namespace pcl::cosection
