// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support_surfaces.h"

#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief A connected part of a plane, and how it ends. Lengths are measured on the plane. */
struct PlaneRegion
{
  int surface = -1;
  int pixels = 0;
  float area_m2 = 0.0f;
  float length_m = 0.0f;            ///< longer side of the smallest rectangle around it
  float border_m = 0.0f;            ///< all of its border beside which there is a reading
  float free_m = 0.0f;              ///< border beyond which what is seen lies behind the plane
  std::map<int, float> before_m;    ///< border beyond which something rises before the plane, by its region; -1: none
  std::map<int, float> continued_m; ///< border to other regions of the plane
  std::map<int, float> edge_m;      ///< convex edges at which regions of other planes begin
};

/** \brief Regions of the planes of a view. */
struct PlaneRegions
{
  std::vector<int> region_of; ///< one per pixel, -1 for none
  std::vector<PlaneRegion> regions;
};

/** \brief Divides planes into connected regions. Strips, as the edge of a board is, are divided from what is wider:
 * the front of a box that is as far away as the edge of the shelf. A strip goes on through what is wider. What is in
 * front of a plane may divide a region, but two faces that end freely on their sides are not one behind it.
 * \param[in] surface_of one per pixel: the plane it is on; -1: none */
PlaneRegions dividePlanes (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces,
                           const std::vector<int>& surface_of, float max_object_size_m);

} // namespace pcl::cosection
