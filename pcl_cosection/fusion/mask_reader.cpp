// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>

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
  if (more_ > 0)
    result.push_back ("and " + std::to_string (more_) + (more_ == 1 ? " more warning" : " more warnings") +
                      " about masks");
  return result;
}

} // namespace pcl::cosection
