// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace pcl::cosection {

/** \brief Queries about places where the object was not observed, in its frame. */
struct UnseenPlaces
{
  std::function<bool (const Eigen::Vector3d&)> is_free;         // was seen free
  std::function<bool (const Eigen::Vector3d&)> is_of_other;     // may belong to another body
  std::function<bool (const Eigen::Vector3d&)> is_behind_other; // behind the surface of something else

  bool isTaken (const Eigen::Vector3d& p) const { return is_free (p) || is_of_other (p); }
};

/** \brief Points of hidden walls behind other things.
 *
 * A wall whose lowest observed points are no edge, as something else begins to hide it there, is continued straight
 * down to the plane with its inclination, unless free space or another body is on the way.
 * \param[in] points of the object
 * \param[in] plane on which it stands: unit normal upwards, and offset
 * \param[in] step_m between the points */
std::vector<OrientedPoint> wallsBehindOthers (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                                              double step_m, const UnseenPlaces& places);

} // namespace pcl::cosection
