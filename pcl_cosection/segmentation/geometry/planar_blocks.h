// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "depth_grid.h"

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

constexpr int block_px = 8; ///< planes are sought among square blocks of so many pixels

/** \brief The mean of a square of pixels that lie on one smooth surface. */
struct PlanarBlock
{
  Eigen::Vector3f centre, normal;
  float area_m2 = 0.0f; ///< 0: nothing flat there
  float sigma = 0.0f;
};

struct BlockImage
{
  int width, height;
  std::vector<PlanarBlock> blocks;
};

/** \brief Blocks are flat by their mean normal, or, where the surface is seen at too small an angle or from too far for
 * normals, by a plane through the inverse depths of all their pixels: these are linear in the image on a plane, and
 * their noise is the same at any angle.
 * \param[in] grazing also find the latter */
BlockImage findPlanarBlocks (const DepthGrid& grid, bool grazing);

/** \brief A plane that many blocks lie on. */
struct PlaneProposal
{
  Eigen::Vector3f normal = Eigen::Vector3f::Zero (); ///< unit, towards the sensor
  float offset = 0.0f;                               ///< normal.x + offset: height above the plane
  std::vector<int> blocks;                           ///< of its largest groups
  float area_m2 = 0.0f;                              ///< of these
  bool large = false;                                ///< whether a group of them is longer than an object

  bool holds (const PlanarBlock& block) const;
};

/** \brief The planes of a view, the one with the most surface first. Those without a group of blocks longer than
 * \a max_object_size_m end with what has less than half of \a min_area_m2. */
std::vector<PlaneProposal> proposePlanes (const BlockImage& image, float max_object_size_m, float min_area_m2);

} // namespace pcl::cosection
