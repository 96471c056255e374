// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/pixel_region.h"
#include <pcl/cosection/common/camera.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief How much the depth along a ray must exceed that of a point for the point to be free, metres:
 * max (3 voxels, 3 sigma_z). */
double freeSpaceMargin (const DepthView& view, double depth_m, double voxel_size_m);

/** \brief The least that it can be. */
double leastFreeSpaceMargin (double voxel_size_m);

/** \brief Minimum or \a maximum of an image over a square window of \a radius pixels around every pixel of a region;
 * other pixels of the result have no meaning. */
std::vector<float> filterDepth (const std::vector<float>& image, const PinholeCamera& camera, int radius, bool maximum,
                                const PixelRegion& region);

/** \brief A depth view prepared for looking up free space. */
class FreeSpaceView
{
public:
  static constexpr std::size_t bytes_per_pixel = 2 * sizeof (float) + sizeof (std::uint8_t);

  explicit FreeSpaceView (DepthView view);

  const DepthView& view () const { return view_; }

  /** \brief True if the pixel lies at a depth discontinuity, where readings are not to be trusted. */
  bool atEdge (int u, int v) const { return edge_[static_cast<std::size_t> (v) * view_.camera.width + u] != 0; }

  /** \brief The nearest reading within \a radius pixels (square window) of every pixel of a region; infinity if none.
   * Other pixels of the result have no meaning. */
  std::vector<float> nearestDepth (int radius, const PixelRegion& region) const;

  /** \brief The depth without patches of less than 3 x 3 pixels that are farther than what surrounds them
   * (morphological opening); 0 where there is no reading. */
  const std::vector<float>& openedDepth () const { return opened_; }

private:
  DepthView view_;
  std::vector<std::uint8_t> edge_;
  std::vector<float> opened_;
};

} // namespace pcl::cosection
