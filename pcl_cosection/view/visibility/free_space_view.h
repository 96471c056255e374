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
  static constexpr std::size_t bytes_per_pixel = 2 * sizeof (float) + sizeof (std::uint8_t) + sizeof (int);
  static constexpr int unknown_body = -1;

  /** \param[in] bodies by pixel, the body that a reading shows, or unknown_body; empty: none is known */
  explicit FreeSpaceView (DepthView view, std::vector<int> bodies = {});

  const DepthView& view () const { return view_; }

  /** \brief True if the pixel lies at a depth discontinuity, where readings are not to be trusted. */
  bool atEdge (int u, int v) const { return edge_[static_cast<std::size_t> (v) * view_.camera.width + u] != 0; }

  /** \brief Whether a reading is known to show another body. Its surface is not that of \a body, however near. */
  bool showsOther (std::size_t pixel, int body) const
  {
    return body != unknown_body && !bodies_.empty () && bodies_[pixel] != unknown_body && bodies_[pixel] != body;
  }

  /** \brief To which depth the ray of each pixel of a region is free of a body, metres: to the reading of another body,
   * and up to freeSpaceMargin () from any other. \param[in] depth of the view, or as openedDepth ()
   * \param[in] no_reading where there is no reading. Pixels outside of the region have no meaning */
  std::vector<float> freeDepth (const std::vector<float>& depth, int body, double voxel_size_m, float no_reading,
                                const PixelRegion& region) const;

  /** \brief The depth without patches of less than 3 x 3 pixels that are farther than what surrounds them
   * (morphological opening); 0 where there is no reading. */
  const std::vector<float>& openedDepth () const { return opened_; }

private:
  DepthView view_;
  std::vector<int> bodies_;
  std::vector<std::uint8_t> edge_;
  std::vector<float> opened_;
};

} // namespace pcl::cosection
