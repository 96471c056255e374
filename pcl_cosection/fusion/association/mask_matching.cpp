// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mask_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace pcl::cosection {

MaskMatches
matchMasks (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& rendered, const Image<float>& depth,
            double min_iou)
{
  if (mask.pixels.size () != rendered.pixels.size () || mask.pixels.size () != depth.pixels.size ())
    throw InvalidArgument ("masks can be matched with an image of their own size only");
  MaskMatches matches;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> common;
  for (std::size_t n = 0; n < mask.pixels.size (); ++n)
  {
    const std::uint16_t instance = mask.pixels[n];
    const std::uint16_t object = rendered.pixels[n];
    if ((instance == 0 && object == 0) || !std::isfinite (depth.pixels[n]))
      continue;
    if (instance != 0)
      ++matches.instance_pixels[instance];
    if (object != 0)
      ++matches.object_pixels[object];
    if (instance != 0 && object != 0)
      ++common[{instance, object}];
  }
  std::vector<std::tuple<double, std::uint16_t, std::uint16_t>> pairs;
  for (const auto& [pair, pixels] : common)
  {
    const std::size_t either = matches.instance_pixels[pair.first] + matches.object_pixels[pair.second] - pixels;
    const double iou = static_cast<double> (pixels) / static_cast<double> (either);
    if (iou > min_iou)
      pairs.emplace_back (-iou, pair.first, pair.second);
  }
  std::sort (pairs.begin (), pairs.end ());
  std::set<std::uint16_t> taken;
  for (const auto& [iou, instance, object] : pairs)
    if (matches.object_of.count (instance) == 0 && taken.insert (object).second)
      matches.object_of[instance] = object;
  return matches;
}

} // namespace pcl::cosection
