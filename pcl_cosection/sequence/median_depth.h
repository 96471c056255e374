// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The median of an image's readings; nothing if it has none. */
inline std::optional<float>
medianDepth (const Image<float>& depth)
{
  std::vector<float> readings;
  std::copy_if (depth.pixels.begin (), depth.pixels.end (), std::back_inserter (readings), isReading);
  return readings.empty () ? std::nullopt : std::optional<float> (upperMedian (readings));
}

} // namespace pcl::cosection
