// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_files.h"

#include "numbered_files.h"
#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/mask_image.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double largest_instance = 65533.0; // from 0; 65535 has a meaning of its own
const std::vector<std::string> endings = {".png"};

/** \brief Whether most names are those of a frame and an instance, \a files of \a all: more frames match their first
 * number than their second; if as many do, several files have the same second number or do not match a frame by it.
 * Frames have leading zeros rather than instances. */
bool
arePerInstance (const std::vector<PairedFile>& files, std::size_t all, const std::vector<double>& stamps, double limit)
{
  std::set<double> second;
  std::set<std::size_t> by_first, by_second; // frames
  std::size_t matched = 0;
  for (const PairedFile& file : files)
  {
    if (file.second > largest_instance || file.second != std::floor (file.second))
      return false;
    if (const auto frame = nearestStamp (stamps, file.first, limit))
      by_first.insert (*frame);
    second.insert (file.second);
    if (const auto frame = nearestStamp (stamps, file.second, limit))
    {
      by_second.insert (*frame);
      ++matched;
    }
  }
  const bool are_frames_second = std::all_of (files.begin (), files.end (),
                                              [] (const PairedFile& file) { return file.is_second_padded; });
  if (are_frames_second || by_first.empty () || by_first.size () < by_second.size () || 2 * files.size () <= all)
    return false;
  return by_first.size () > by_second.size () || second.size () < files.size () || matched < files.size ();
}

/** \brief PNGs whose names are not those of a frame and an instance. */
std::vector<std::string>
otherImages (const std::string& folder, const std::vector<std::string>& pngs, const std::vector<PairedFile>& paired)
{
  std::set<std::string> known;
  for (const PairedFile& file : paired)
    known.insert (file.path.substr (file.path.find_last_of ('/') + 1));
  std::vector<std::string> others;
  for (const std::string& name : pngs)
    if (known.count (name) == 0)
      others.push_back (folder + '/' + name);
  return others;
}

/** \brief The files of a folder whose names begin alike, by what they begin with. */
using Series = std::map<std::string, std::vector<NumberedFile>>;

/** \brief Two files of different series with the same number; nothing if there are none. */
std::optional<std::pair<std::string, std::string>>
sameNumber (const Series& series)
{
  std::map<double, std::string> paths;
  for (const auto& [beginning, files] : series)
    for (const NumberedFile& file : files)
      if (const auto [other, is_new] = paths.try_emplace (file.number, file.path); !is_new)
        return std::pair (other->second, file.path);
  return std::nullopt;
}

/** \brief What a name begins with, without the characters that join it with the number: "carton_", "carton". */
std::string
withoutJoint (std::string beginning)
{
  while (!beginning.empty () && (beginning.back () == '_' || beginning.back () == '-'))
    beginning.pop_back ();
  return beginning;
}

bool
haveSameNumbers (const Series& series)
{
  const std::vector<NumberedFile>& first = series.begin ()->second;
  return std::all_of (series.begin (), series.end (), [&] (const auto& each) {
    return std::equal (first.begin (), first.end (), each.second.begin (), each.second.end (),
                       [] (const NumberedFile& a, const NumberedFile& b) { return a.number == b.number; });
  });
}

/** \brief Whether the first file of each series is an image of one instance. */
bool
areOfOneInstance (const Series& series)
try
{
  return std::all_of (series.begin (), series.end (), [] (const auto& each) {
    const Image<std::uint16_t> mask = loadMaskImage (each.second.front ().path);
    std::set<std::uint16_t> values (mask.pixels.begin (), mask.pixels.end ());
    values.erase (0);
    return values.size () <= 1;
  });
}
catch (const IoError&)
{
  return false;
}

/** \brief The number of an instance by what the names of its masks begin with: their own numbers, from 1, or those of
 * the order of the alphabet. */
std::map<std::string, std::uint16_t>
instancesOf (const Series& series)
{
  std::map<std::string, std::uint16_t> own, in_order;
  std::set<std::uint16_t> taken;
  for (const auto& [beginning, files] : series)
  {
    in_order[beginning] = static_cast<std::uint16_t> (in_order.size () + 1);
    const std::optional<double> number = numberAtEnd (withoutJoint (beginning));
    if (number && *number >= 1.0 && *number <= largest_instance && *number == std::floor (*number) &&
        taken.insert (static_cast<std::uint16_t> (*number)).second)
      own[beginning] = static_cast<std::uint16_t> (*number);
  }
  return own.size () == series.size () ? own : in_order;
}

/** \brief Take the series as masks of one object each: OBJECT_FRAME.png. */
void
addObjects (const Series& series, MaskFiles& masks)
{
  masks.per_instance = true;
  std::string meanings;
  bool are_numbers = true;
  for (const auto& [beginning, instance] : instancesOf (series))
  {
    const std::string name = withoutJoint (beginning), number = std::to_string (instance);
    meanings += (meanings.empty () ? "" : ", ") + number + " is " + name;
    are_numbers = are_numbers && name == number;
    for (const NumberedFile& file : series.at (beginning))
      masks.by_stamp[file.number].push_back ({file.path, instance});
  }
  if (!are_numbers)
    masks.warnings.push_back (series.begin ()->second.front ().path + " and others: are masks of one object each, " +
                              "OBJECT_FRAME.png; instance " + meanings);
}

/** \brief The files that end in a number. \throws IoError if several are of one frame, and what they are is not known
 */
void
addNumbered (const std::string& folder, const std::vector<std::string>& names, MaskFiles& masks)
{
  std::vector<std::string> ignored;
  Series series;
  for (const std::string& beginning : beginningsOf (names, endings))
    series[beginning] = numberedFiles (folder, names, {{beginning}, endings}, ignored);
  NumberedNames usual = {{}, endings};
  if (const auto same = sameNumber (series))
  {
    std::vector<std::string> others;
    for (const auto& [beginning, files] : series)
      if (withoutJoint (beginning) == "mask")
        usual.beginnings.push_back (beginning);
      else
        std::transform (files.begin (), files.end (), std::back_inserter (others),
                        [] (const NumberedFile& file) { return file.path; });
    if (usual.beginnings.empty () && haveSameNumbers (series) && areOfOneInstance (series))
      return addObjects (series, masks);
    if (usual.beginnings.empty ())
      throw IoError (folder + ": has several masks for one frame, such as " + same->first + " and " + same->second +
                     "; keep one of each frame, or name those of single objects FRAME_INSTANCE.png");
    masks.warnings.push_back (firstAndMore (others) + ": left out; masks of the same frames are named MaskNNNN.png");
  }
  for (const NumberedFile& file : numberedImages (folder, usual, masks.warnings))
    masks.by_stamp[file.number].push_back ({file.path, 0});
}

} // namespace

MaskFiles
listMaskFiles (const std::string& folder, const std::vector<double>& stamps, double limit)
{
  const std::vector<std::string> names = fileNames (folder);
  const std::vector<PairedFile> paired = pairedFiles (folder, names, endings);
  std::vector<std::string> pngs;
  std::copy_if (names.begin (), names.end (), std::back_inserter (pngs), [] (const std::string& name) {
    return name.size () > 4 && name.compare (name.size () - 4, 4, ".png") == 0;
  });
  MaskFiles masks;
  masks.per_instance = arePerInstance (paired, pngs.size (), stamps, limit);
  if (masks.per_instance)
  {
    for (const PairedFile& file : paired)
      masks.by_stamp[file.first].push_back ({file.path, static_cast<std::uint16_t> (file.second + 1.0)});
    if (const std::vector<std::string> others = otherImages (folder, pngs, paired); !others.empty ())
      masks.warnings.push_back (firstAndMore (others) + ": left out; the other names are FRAME_INSTANCE.png");
  }
  else
    addNumbered (folder, names, masks);
  if (masks.by_stamp.empty ())
    throw IoError (folder + ": has no masks: it " + contentsOf (folder) +
                   "; masks must be PNGs in this folder, named " +
                   "MaskNNNN.png, FRAME_INSTANCE.png, or another name that ends in a frame's number or stamp");
  return masks;
}

} // namespace pcl::cosection
