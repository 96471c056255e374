// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/rgbd_sequence.h>

#include "mask_files.h"
#include "numbered_files.h"
#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/mask_image.h"
#include "resized_image.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t speck_px = 100; // an instance of fewer is hardly an object
// Such instances of a mask: none in nine sequences of masks (toycars, reports of others); 17 to 90 after a blur, a
// change of size or JPEG of the same. Halfway.
constexpr std::size_t most_specks = 8;
constexpr std::uint16_t eight_bit_void = 255; // of PASCAL VOC and others
constexpr double band_share = 0.02;           // half a band's width, of the image's: VOC's has 5 of 500 pixels in all

/** \brief How many values of a mask cover few pixels each: many where it was scaled or compressed as a photograph. */
std::size_t
countSpecks (const Image<std::uint16_t>& mask)
{
  std::map<std::uint16_t, std::size_t> pixels;
  for (const std::uint16_t value : mask.pixels)
    ++pixels[value];
  return static_cast<std::size_t> (std::count_if (
      pixels.begin (), pixels.end (), [] (const auto& value) { return value.first != 0 && value.second < speck_px; }));
}

/** \brief The instance that covers most of a mask and touches all four of its borders, as the surroundings of things
 * do; 0 if there is none. */
std::uint16_t
surroundingInstance (const Image<std::uint16_t>& mask)
{
  std::map<std::uint16_t, std::size_t> pixels;
  std::map<std::uint16_t, std::set<int>> borders;
  for (int v = 0; v < mask.height; ++v)
    for (int u = 0; u < mask.width; ++u)
    {
      const std::uint16_t value = mask.at (u, v);
      ++pixels[value];
      const std::array<bool, 4> at = {u == 0, v == 0, u + 1 == mask.width, v + 1 == mask.height};
      for (int border = 0; border < 4; ++border)
        if (at[border])
          borders[value].insert (border);
    }
  const auto most = std::find_if (pixels.begin (), pixels.end (), [&] (const auto& value) {
    return 2 * value.second > mask.pixels.size () && borders[value.first].size () == 4;
  });
  return most == pixels.end () ? std::uint16_t (0) : most->first;
}

/** \brief Whether a value is that of what is not known: it is nowhere wider than a band, and beside all instances. */
bool
isVoid (const Image<std::uint16_t>& mask, std::uint16_t value)
{
  const int band_px = std::max (1, static_cast<int> (band_share * mask.width));
  std::set<std::uint16_t> instances (mask.pixels.begin (), mask.pixels.end ()), beside;
  if (instances.erase (value) == 0)
    return false;
  instances.erase (0);
  const auto at = [&] (int u, int v) {
    return mask.at (std::clamp (u, 0, mask.width - 1), std::clamp (v, 0, mask.height - 1));
  };
  for (int v = 0; v < mask.height; ++v)
    for (int u = 0; u < mask.width; ++u)
    {
      if (mask.at (u, v) != value)
        continue;
      int far = 0;
      for (const int y : {-1, 0, 1})
        for (const int x : {-1, 0, 1})
        {
          beside.insert (at (u + x, v + y));
          far += at (u + band_px * x, v + band_px * y) == value;
        }
      if (far == 9)
        return false;
    }
  return !instances.empty () && std::includes (beside.begin (), beside.end (), instances.begin (), instances.end ());
}

} // namespace

MaskSequence::MaskSequence (const std::string& folder, const RgbdSequence& sequence)
    : half_period_ (0.5 * sequence.period ())
    , width_ (sequence.camera ().width)
    , height_ (sequence.camera ().height)
{
  const std::vector<double> stamps = sequence.stamps ();
  MaskFiles masks = listMaskFiles (folder, stamps, half_period_);
  per_instance_ = masks.per_instance;
  warnings_ = std::move (masks.warnings);
  for (auto& [stamp, files] : masks.by_stamp)
  {
    stamps_.push_back (stamp);
    files_.push_back (std::move (files));
  }
  std::vector<bool> matches (files_.size ());
  for (const double stamp : stamps)
    if (const auto nearest = nearestStamp (stamps_, stamp, half_period_))
      matches[*nearest] = true;
  std::vector<std::string> unmatched;
  for (std::size_t n = 0; n < files_.size (); ++n)
    if (!matches[n])
      unmatched.push_back (files_[n].front ().path);
  if (unmatched.size () == files_.size ())
    throw IoError (folder + ": no mask matches a frame; the masks have the stamps " +
                   stampSpan (stamps_.front (), stamps_.back ()) + ", the frames " +
                   stampSpan (sequence.stamp (0), sequence.stamp (sequence.size () - 1)));
  if (!unmatched.empty ())
    warnings_.push_back (firstAndMore (unmatched) + (unmatched.size () == 1 ? " matches" : " match") + " no frame");
  judgeFirst ();
}

void
MaskSequence::judgeFirst ()
try
{
  const std::string& path = files_.front ().front ().path;
  const Image<std::uint16_t> mask = *read (stamps_.front ());
  has_void_ = !per_instance_ && isVoid (mask, eight_bit_void);
  if (has_void_)
    warnings_.push_back (path + ": 255 is in a narrow band beside all instances, as where masks say 'not known' by it: "
                                "it is left out");
  if (const std::uint16_t instance = surroundingInstance (mask); instance != 0 && instance != ignored_label)
    warnings_.push_back (path + ": instance " + std::to_string (instance) +
                         " covers most of the image and reaches all of its borders, and counts as an object: if it is "
                         "the background, it must be 0");
  if (per_instance_)
    return;
  if (const std::size_t specks = countSpecks (mask); specks > most_specks)
    warnings_.push_back (path + ": has " + std::to_string (specks) + " instances of fewer than " +
                         std::to_string (speck_px) +
                         " pixels: masks must not be blurred, scaled with interpolation, "
                         "or compressed as JPEG");
}
catch (const Error&)
{
  // It is an error of its frame, if that is read.
}

std::optional<std::string>
MaskSequence::file (double stamp) const
{
  const auto nearest = nearestStamp (stamps_, stamp, half_period_);
  if (!nearest)
    return std::nullopt;
  return files_[*nearest].front ().path;
}

Image<std::uint16_t>
MaskSequence::readFile (const std::string& path) const
{
  Image<std::uint16_t> mask = loadMaskImage (path);
  if (has_void_)
    std::replace (mask.pixels.begin (), mask.pixels.end (), eight_bit_void, ignored_label);
  if (mask.width == width_ && mask.height == height_)
    return mask;
  if (haveSameShape (mask.width, mask.height, width_, height_))
    return resized (mask, width_, height_);
  throw IoError (path + ": has " + std::to_string (mask.width) + " x " + std::to_string (mask.height) +
                 " pixels, but the depth images have " + std::to_string (width_) + " x " + std::to_string (height_));
}

std::optional<Image<std::uint16_t>>
MaskSequence::read (double stamp) const
{
  const auto nearest = nearestStamp (stamps_, stamp, half_period_);
  if (!nearest)
    return std::nullopt;
  const std::vector<MaskFile>& files = files_[*nearest];
  if (files.front ().instance == 0)
    return readFile (files.front ().path);
  Image<std::uint16_t> all (width_, height_);
  std::vector<bool> taken (all.pixels.size ());
  for (const MaskFile& file : files)
  {
    const Image<std::uint16_t> mask = readFile (file.path);
    for (std::size_t n = 0; n < taken.size (); ++n)
      if (mask.pixels[n] != 0)
      {
        all.pixels[n] = taken[n] ? 0 : file.instance; // which one is in front is not known
        taken[n] = true;
      }
  }
  return all;
}

} // namespace pcl::cosection
