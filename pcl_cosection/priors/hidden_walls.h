// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace pcl::cosection
{

/** \brief What is known of places where nothing of an object was seen. */
struct UnseenPlaces
{
  std::function<bool (const Eigen::Vector3d&)> is_free;         // was seen free
  std::function<bool (const Eigen::Vector3d&)> is_of_other;     // may be another body's
  std::function<bool (const Eigen::Vector3d&)> is_behind_other; // behind the surface of something else

  bool isTaken (const Eigen::Vector3d& p) const { return is_free (p) || is_of_other (p); }
};

/** \brief Points of walls where something else hides them: what stands behind something goes on down to what it stands
 * on.
 *
 * A wall of which the lowest points that were seen are no edge, as there something else begins to hide it, is continued
 * straight to the plane, leaning as it leans; not if any of the places on the way is taken.
 * \param[in] points of the object \param[in] plane on which it stands: unit normal upwards, and offset \param[in]
 * step_m between the points */
std::vector<OrientedPoint> wallsBehindOthers (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                                              double step_m, const UnseenPlaces& places);

} // namespace pcl::cosection
