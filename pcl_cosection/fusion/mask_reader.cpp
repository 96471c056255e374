// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_reader.h"

#include "pcl_cosection/view/labels/stray_patches.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {

std::optional<Image<std::uint16_t>>
MaskReader::read (const RgbdFrame& frame)
try
{
  std::optional<Image<std::uint16_t>> mask = masks_ ? masks_ (frame) : std::nullopt;
  if (!mask)
    return mask;
  ++used_;
  has_instance_ = has_instance_ || std::any_of (mask->pixels.begin (), mask->pixels.end (), [] (std::uint16_t value) {
                    return value != 0 && value != ignored_label;
                  });
  if (mask->width == frame.depth.width && mask->height == frame.depth.height)
    for (const auto& [label, counts] : relabelStrayPatches (camera_, frame.depth, *mask))
      for (std::size_t n = 0; n < counts.size (); ++n)
        readings_[label][n] += counts[n];
  return mask;
}
catch (const Error& error)
{
  constexpr std::size_t most_warnings = 20;
  if (warnings_.size () < most_warnings)
    warnings_.push_back (std::string (error.what ()) + "; the frame is used without it");
  else
    ++more_;
  return std::nullopt;
}

std::string
MaskReader::emptiness () const
{
  if (used_ == 0 || has_instance_)
    return {};
  return (used_ == 1 ? "the only mask is" : "all " + std::to_string (used_) + " masks are") +
         std::string (" 0 in every pixel; where an object is, they must be its number");
}

std::vector<std::string>
MaskReader::warnings () const
{
  std::vector<std::string> result = warnings_;
  for (const auto& [label, counts] : readings_)
    if (const double share = static_cast<double> (counts[1]) / static_cast<double> (counts[0]); share > much_elsewhere)
      result.push_back (std::to_string (std::lround (100.0 * share)) + " % of the pixels of label " +
                        std::to_string (label) +
                        " of the masks are on other surfaces behind or before it, and count as part of those: masks "
                        "may be shifted, or too large");
  if (more_ > 0)
    result.push_back ("and " + std::to_string (more_) + (more_ == 1 ? " more warning" : " more warnings") +
                      " about masks");
  return result;
}

} // namespace pcl::cosection
