// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief Parameters of computeOrganizedNormals (). */
struct PCL_COSECTION_EXPORT OrganizedNormalsOptions
{
  double radius_m = 0.01;          ///< half width of the window on the surface
  int min_radius_px = 3;           ///< the window is never smaller, pixels
  int max_radius_px = 7;           ///< nor larger, pixels; at most 15
  double min_support = 1.0 / 3.0;  ///< share of the window's pixels that must lie on the fitted plane
  double max_incidence_rad = 1.45; ///< largest angle between the normal and the direction to the sensor
  int threads = 0;                 ///< 0: all

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Normals of an organised cloud in its sensor frame.
 *
 * A plane is fitted to the covariance of the pixels in a square window around each point. Only
 * pixels of the same label count, and only those that the point reaches along rows and columns
 * without a jump in range larger than the sensor's noise (depthNoiseSigma ()) and a surface tilted
 * by 75 degrees explain; pixels far from a first fit are trimmed, and the rest is fitted again.
 * Points without enough support, off the plane of their neighbours (as \e flying pixels at depth
 * edges are), on something that is no plane, or seen at too flat an angle get no normal.
 *
 * \param[in] points width * height points, row by row, sensor at the origin; not finite: no reading
 * \param[in] labels empty, or one per point
 * \return one per point: unit, towards the sensor; NaN where there is no reliable normal
 * \throws InvalidArgument if the sizes do not agree
 *
 * O (width * height * window); the result does not depend on the number of threads.
 * \code
 * const auto normals = computeOrganizedNormals (points, 640, 480, labels);
 * \endcode */
PCL_COSECTION_EXPORT std::vector<Eigen::Vector3f>
computeOrganizedNormals (const std::vector<Eigen::Vector3f>& points, int width, int height,
                         const std::vector<std::uint32_t>& labels = {}, const OrganizedNormalsOptions& options = {});

} // namespace pcl::cosection
