// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include <pcl/cosection/common/image.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Call f (a, b) for all pixels beside each other that show one surface. */
template <typename Function>
void
forNeighbours (const FrameCloud& cloud, Function&& f)
{
  constexpr float same_surface = 0.02f; // of the depth: a larger step to the next pixel leads to another surface
  const int width = cloud.camera.width;
  for (int v = 0; v < cloud.camera.height; ++v)
    for (int u = 0; u < width; ++u)
      for (const auto& [du, dv] : {std::pair (1, 0), std::pair (0, 1)})
      {
        if (u + du >= width || v + dv >= cloud.camera.height)
          continue;
        const std::size_t a = static_cast<std::size_t> (v) * width + u;
        const std::size_t b = static_cast<std::size_t> (v + dv) * width + u + du;
        if (std::abs (cloud.depth.pixels[a] - cloud.depth.pixels[b]) < same_surface * cloud.depth.pixels[a])
          f (a, b);
      }
}

/** \brief Connected components of unassigned pixels, in the image and in depth. */
struct UnassignedComponents
{
  static constexpr int none = -1;

  std::vector<int> of_pixel;       ///< number of its component from 0, or none
  std::vector<std::size_t> pixels; ///< by component
  std::vector<bool> cut;           ///< by component: the border of the view cuts it, its size is not known

  /** \brief Whether a component may be a part of an object of so many pixels. A hand that holds it is larger or cut. */
  bool mayBelongTo (int component, std::size_t object_pixels) const
  {
    return !cut[component] && pixels[component] < object_pixels;
  }
};

/** \brief Find the connected components. \param[in] unassigned one per pixel */
UnassignedComponents findUnassignedComponents (const std::vector<bool>& unassigned, const FrameCloud& cloud);

/** \brief Instances that the border of the view cuts, without 0 and FrameSegmenter::ignored. */
std::set<std::uint16_t> cutInstances (const Image<std::uint16_t>& mask, const FrameCloud& cloud);

} // namespace pcl::cosection
