// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_priors.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Surface that is expected where something else hides an object. */
struct Continuation
{
  std::vector<OrientedPoint> points;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero (); ///< in which it goes on, unit length; zero: it does not
};

/** \brief How an object goes on behind the surface of something else that is nearer to the sensor (amodal completion).
 *
 * The end of the object beside what hides it is moved along the plane to where it is hidden. It goes on in the
 * direction in which copies of the end, moved the other way, have most evidence (CopyEvidence): along the axis of what
 * has a constant cross-section. It goes on until the object itself is seen again or, as all lengths up to that are as
 * likely, half the way to where a view shows that it is not, at most half the length that was seen.
 * \param[in] plane on which the object stands, unit normal towards it, the object's frame
 * \return no points if nothing hides the object or its cross-section changes */
Continuation continuedBehindOthers (const Observation& object, const Eigen::Vector4d& plane);

} // namespace pcl::cosection
