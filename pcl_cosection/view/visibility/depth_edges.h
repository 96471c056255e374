// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

namespace pcl::cosection {

// A depth edge is where two neighbouring pixels see different surfaces. Noise and a tilted surface make depths differ,
// too: from a pixel to the next by depthNoiseSigma () several times over, and by the tangent of the angle between the
// surface and the image times the pixel's width. Between a step that a surface surely explains and one that surely is
// an edge lie steps that say neither; so there are two bounds, one for each question.

/** \brief The largest step in depth, or in range, that is still taken for one surface: four standard deviations, and a
 * tilt of 75 degrees. Ask with this what belongs together.
 * \param[in] depth_m of the nearer pixel \param[in] across_m distance of the two across the ray, metres
 * \param[in] working_range_m of the sensor */
inline double
largestSurfaceStep (double depth_m, double across_m, double working_range_m = 1.0)
{
  constexpr double sigmas = 4.0;
  constexpr double slope = 3.7; // tan (75 degrees)
  return sigmas * depthNoiseSigma (depth_m, working_range_m) + slope * across_m;
}

/** \brief The smallest step in depth that is surely an edge, so that readings beside it may be mixed from both sides:
 * six standard deviations, and 3 % of the depth, which is a tilt of 86 degrees from pixel to pixel of a VGA camera. Ask
 * with this which readings not to trust. \param[in] depth_m of the nearer pixel \param[in] working_range_m of the
 * sensor */
inline double
smallestEdgeStep (double depth_m, double working_range_m = 1.0)
{
  constexpr double sigmas = 6.0;
  constexpr double slope = 0.03;
  return sigmas * depthNoiseSigma (depth_m, working_range_m) + slope * depth_m;
}

} // namespace pcl::cosection
