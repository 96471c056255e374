// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>

namespace pcl::cosection {

/** \brief Extents of a region in its plane, metres. */
struct RegionExtents
{
  static constexpr int directions = 12; ///< in which regions are measured, over half a turn

  std::array<float, directions> low, high;

  RegionExtents ()
  {
    low.fill (std::numeric_limits<float>::max ());
    high.fill (std::numeric_limits<float>::lowest ());
  }

  void add (int direction, float along)
  {
    low[direction] = std::min (low[direction], along);
    high[direction] = std::max (high[direction], along);
  }

  /** \brief The longer side of the smallest rectangle. */
  float length () const
  {
    float least = std::numeric_limits<float>::max ();
    for (int k = 0; k < directions / 2; ++k)
      least = std::min (least, std::max (high[k] - low[k], high[k + directions / 2] - low[k + directions / 2]));
    return (least);
  }
};

} // namespace pcl::cosection
