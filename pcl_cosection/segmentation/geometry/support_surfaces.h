// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planar_blocks.h"

namespace pcl::cosection {

/** \brief A large plane of the room, as far as it is seen. */
struct SupportSurface
{
  Eigen::Vector3f normal; ///< unit, towards the sensor
  float offset;           ///< normal.x + offset: height above the plane
  /** \brief Height of the readings themselves as a quadric in the pixel's place, for the sensor's distortion:
   * coefficients of 1, u, v, u u, u v, v v with u and v from -1 to 1 over the image. */
  Eigen::Matrix<float, 6, 1> distortion;
  float area_m2;                        ///< of what is seen of it
  Eigen::Vector3f axis_u, axis_v;       ///< unit, in the plane
  std::vector<Eigen::Vector2f> outline; ///< convex hull of what is seen, in those axes, counter-clockwise

  /** \brief Height of a point above the plane. */
  float height (const Eigen::Vector3f& p) const { return (normal.dot (p) + offset); }

  /** \brief Distance of pixel (u, v) without the sensor's distortion, in multiples of what noise and its normal allow.
   */
  float distance (const DepthGrid& grid, int u, int v) const;

  /** \brief Foot of a point in the plane's axes. */
  Eigen::Vector2f place (const Eigen::Vector3f& p) const { return {axis_u.dot (p), axis_v.dot (p)}; }

  /** \brief Whether the foot of a pixel's point is inside of the outline, or no farther than \a margin_m from it; or in
   * reach of it where the camera does not look. */
  bool carries (const DepthGrid& grid, int pixel, float margin_m) const;
};

/** \brief A plane as far as its blocks reach. */
SupportSurface makeSurface (const DepthGrid& grid, const BlockImage& image, const PlaneProposal& plane);

/** \brief The planes of a view that are too large for an object, largest first. The first one may be as small as
 * \a min_area_m2, the others must be longer than \a max_object_size_m. */
std::vector<SupportSurface> findSupportSurfaces (const DepthGrid& grid, float max_object_size_m, float min_area_m2);

} // namespace pcl::cosection
