// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "depth_grid.h"

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief A small connected piece of surface with one orientation. */
struct SurfacePatch
{
  Eigen::Vector3f centre = Eigen::Vector3f::Zero ();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero (); ///< mean, unit; zero if no pixel has one
  Eigen::Matrix3f spread = Eigen::Matrix3f::Zero (); ///< sum of the pixels' (p - centre) (p - centre)^T
  Eigen::Matrix3f bend = Eigen::Matrix3f::Zero ();   ///< sum of (p - centre) (n - normal)^T
  int pixels = 0;

  /** \brief Normal curvature along a unit direction, 1/m: positive where the surface is convex. */
  float curvature (const Eigen::Vector3f& direction) const
  {
    const float length2 = direction.dot (spread * direction);
    return (length2 > 0.0f ? direction.dot (bend * direction) / length2 : 0.0f);
  }
};

struct PatchImage
{
  std::vector<int> patch_of; ///< one per pixel: index of its patch, -1 for none
  std::vector<SurfacePatch> patches;
};

/** \brief Divides pixels into patches of about one size in the image: k-means in place and normal among the nearest
 * cells of a grid (R. Achanta et al., "SLIC Superpixels Compared to State-of-the-art Superpixel Methods", PAMI 2012),
 * then connected pieces of each.
 * \param[in] used one per pixel: whether it takes part */
PatchImage computeSurfacePatches (const DepthGrid& grid, const std::vector<char>& used, int threads);

} // namespace pcl::cosection
