// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/segmentation/geometry/depth_grid.h"
#include "pcl_cosection/segmentation/geometry/support_surfaces.h"

#include <vector>

namespace pcl::cosection {

/** \brief Which of the planes of a view each pixel lies on. */
class PlaneLabelling
{
public:
  PlaneLabelling (const DepthGrid& grid, float max_object_size_m, float min_area_m2, int threads);

  /** \brief Give the pixels without a plane to the one that fits them best: of those with blocks that are together
   * longer than an object, which go on through the whole image; with \a small also of the others, which go on only as
   * far as they are connected to where they were found. */
  void label (bool small);

  /** \brief Take away the pixels that are not \a kept. */
  void withdraw (const std::vector<char>& kept);

  const std::vector<SupportSurface>& surfaces () const { return (surfaces_); }

  /** \brief One per pixel: its plane, -1 for none. */
  const std::vector<int>& surfaceOf () const { return (surface_of_); }

private:
  void spread ();

  const DepthGrid& grid_;
  const int threads_;
  int blocks_across_ = 0;
  std::vector<SupportSurface> surfaces_;
  std::vector<char> large_;
  std::vector<std::vector<char>> near_; ///< one per block, of small planes: 2 its own, 1 beside one
  std::vector<int> surface_of_;
};

} // namespace pcl::cosection
