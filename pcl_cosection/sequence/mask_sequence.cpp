// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/rgbd_sequence.h>

#include "numbered_files.h"
#include "pcl_cosection/io/image_io.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {

MaskSequence::MaskSequence (const std::string& folder, const RgbdSequence& sequence)
    : half_period_ (0.5 * sequence.period ())
    , width_ (sequence.camera ().width)
    , height_ (sequence.camera ().height)
{
  for (NumberedFile& file : numberedFiles (folder, fileNames (folder), {{}, {".png"}}, warnings_))
  {
    stamps_.push_back (file.number);
    paths_.push_back (std::move (file.path));
  }
  if (paths_.empty ())
    throw IoError (folder + ": has no masks; their names should be MaskNNNN.png, or end in a frame's stamp");
  std::vector<bool> matches (paths_.size ());
  for (const double stamp : sequence.stamps ())
    if (const auto nearest = nearestStamp (stamps_, stamp, half_period_))
      matches[*nearest] = true;
  std::vector<std::string> unmatched;
  for (std::size_t n = 0; n < paths_.size (); ++n)
    if (!matches[n])
      unmatched.push_back (paths_[n]);
  if (unmatched.size () == paths_.size ())
    throw IoError (folder + ": no mask matches a frame; the masks have the stamps " +
                   stampSpan (stamps_.front (), stamps_.back ()) + ", the frames " +
                   stampSpan (sequence.stamp (0), sequence.stamp (sequence.size () - 1)));
  if (!unmatched.empty ())
    warnings_.push_back (firstAndMore (unmatched) + (unmatched.size () == 1 ? " matches" : " match") + " no frame");
}

std::optional<std::string>
MaskSequence::file (double stamp) const
{
  const auto nearest = nearestStamp (stamps_, stamp, half_period_);
  if (!nearest)
    return std::nullopt;
  return paths_[*nearest];
}

std::optional<Image<std::uint16_t>>
MaskSequence::read (double stamp) const
{
  const std::optional<std::string> path = file (stamp);
  if (!path)
    return std::nullopt;
  Image<std::uint16_t> mask = loadMaskImage (*path);
  if (mask.width != width_ || mask.height != height_)
    throw IoError (*path + ": has " + std::to_string (mask.width) + " x " + std::to_string (mask.height) +
                   " pixels, but the depth images have " + std::to_string (width_) + " x " + std::to_string (height_));
  return mask;
}

} // namespace pcl::cosection
