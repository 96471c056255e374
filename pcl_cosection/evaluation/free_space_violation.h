// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief How much of a surface lies where a camera saw free space. */
struct FreeSpaceViolation
{
  double share = 0.0;       ///< of the points that lie in front of what some view measured
  double max_depth_m = 0.0; ///< the farthest that a point lies in front, along the optical axis
  std::size_t in_view = 0;  ///< points at which some view has readings around their pixel
};

/** \brief Compare points of a surface with what views measured.
 *
 * A point violates free space if it is nearer than all four readings around its image, by more than \a tolerance_m: at
 * an outline the nearest of them counts. Where one of the four has no reading the view says nothing. Area-uniform
 * points (sampleSurface ()) make the share one of the area. Before a distant wall, the smallest bulge is as deep as the
 * wall is far.
 * \param[in] points metres, world frame
 * \throws InvalidArgument if a view is not valid, or the tolerance is not a number of metres, 0 or more */
FreeSpaceViolation measureFreeSpaceViolation (const std::vector<Eigen::Vector3d>& points,
                                              const std::vector<DepthView>& views, double tolerance_m = 0.01);

} // namespace pcl::cosection
