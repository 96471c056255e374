// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

/** \brief Agreement of labels with the true ones. */
struct LabelComparison
{
  std::map<std::uint32_t, double> best_iou; ///< by true object: largest intersection over union with a found object
  double mean_iou = 0.0;                    ///< mean of these
  std::size_t background_pixels = 0;        ///< of the largest found object that is mostly background
};

/** \brief \param[in] valid one per pixel: whether it has a reading; others do not count */
inline LabelComparison
compareLabels (const std::vector<std::uint32_t>& truth, const std::vector<std::uint32_t>& found,
               const std::vector<char>& valid)
{
  std::map<std::uint32_t, std::size_t> true_pixels, found_pixels;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> common;
  for (std::size_t i = 0; i < truth.size (); ++i)
  {
    if (!valid[i])
      continue;
    ++true_pixels[truth[i]];
    ++found_pixels[found[i]];
    ++common[{truth[i], found[i]}];
  }
  LabelComparison result;
  for (const auto& [object, pixels] : true_pixels)
    if (object > 0)
      result.best_iou[object] = 0.0;
  for (const auto& [pair, pixels] : common)
  {
    const auto [object, piece] = pair;
    if (object > 0 && piece > 0)
    {
      const double iou = static_cast<double> (pixels) /
                         static_cast<double> (true_pixels[object] + found_pixels[piece] - pixels);
      result.best_iou[object] = std::max (result.best_iou[object], iou);
    }
    if (object == 0 && piece > 0 && 2 * pixels > found_pixels[piece])
      result.background_pixels = std::max (result.background_pixels, found_pixels[piece]);
  }
  for (const auto& [object, iou] : result.best_iou)
    result.mean_iou += iou / static_cast<double> (result.best_iou.size ());
  return (result);
}

} // namespace pcl::cosection::test
