// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/outliers/point_clusters.h"
#include "pcl_cosection/view/sensor_view.h"
#include "pcl_cosection/view/visibility/depth_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Call \a visit (j) for the pixels beside \a i. */
template <typename Visit>
void
visitBeside (const SensorCloud& cloud, std::size_t i, Visit&& visit)
{
  const auto width = static_cast<std::size_t> (cloud.width);
  if (i % width > 0)
    visit (i - 1);
  if (i % width + 1 < width)
    visit (i + 1);
  if (i >= width)
    visit (i - width);
  if (i + width < cloud.positions.size ())
    visit (i + width);
}

/** \brief Whether two readings that are side by side in the image, or so many \a pixels apart, may be on one surface.
 */
inline bool
onOneSurface (const PinholeCamera& camera, const SensorCloud& cloud, std::size_t i, std::size_t j, int pixels = 1)
{
  const double a_m = cloud.positions[i].z (), b_m = cloud.positions[j].z ();
  const double nearer_m = std::min (a_m, b_m);
  return std::abs (a_m - b_m) <= largestSurfaceStep (nearer_m, pixels * nearer_m / camera.fx, cloud.working_range_m);
}

/** \brief Whether a surface goes on beyond an outline in the image, as beyond no object's.
 *
 * In simulated views of scanned objects, it goes on beyond 0.9 of the outline of a label that is three pixels too
 * small, and beyond at most 0.58 of that of an exact label. A sensor that smears edges has 0.6 to 0.95 for exact
 * labels, too: what it smears is taken for the object's.
 *
 * \param[in] continued pairs of readings on the two sides of the outline that are on one surface
 * \param[in] all pairs: with few, as among missing readings, nothing is known of what is beside it
 * \param[in] pixels within the outline \param[in] least share of the pairs that are on one surface */
inline bool
goesOnBeyond (std::size_t continued, std::size_t all, std::size_t pixels, double least = 0.6)
{
  constexpr double least_side = 1.0; // in sides of a square of as many pixels
  return static_cast<double> (all) >= least_side * std::sqrt (static_cast<double> (pixels)) &&
         static_cast<double> (continued) >= least * static_cast<double> (all);
}

/** \brief The parts of a label that depth edges separate. */
struct LabelPatches
{
  std::vector<std::size_t> patch_of; ///< by reading, a number less than theirs, or no_patch
  std::vector<std::size_t> sizes;    ///< by patch, in pixels
  std::size_t largest = 0;           ///< patch
};

/** \param[in] points of the label, at least one \param[in] reach_m from one to the next of a patch */
LabelPatches patchesOf (const std::vector<Eigen::Vector3f>& points, double reach_m);

/** \param[in] readings of the label, at least one */
LabelPatches patchesOf (const PinholeCamera& camera, const SensorCloud& cloud,
                        const std::vector<std::size_t>& readings);

} // namespace pcl::cosection
