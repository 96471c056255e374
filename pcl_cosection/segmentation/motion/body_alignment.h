// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion_view.h"

namespace pcl::cosection {

/** \brief A part of a view that may move, and an earlier view of it. */
struct BodySightings
{
  const MotionView& now;
  const std::vector<int>& pixels; ///< of the body in it
  const MotionView& then;
  const std::vector<int>& gone; ///< pixels of the earlier view that are seen through now: of this body or of others
};

/** \brief Find where a body was, by Gauss-Newton on robust point-to-plane distances to the earlier view's surface.
 * Points that come to where the earlier view has seen through are drawn to its surface beside them, and what is gone
 * since to the body's: so the outline holds it where a surface slides in itself. What neither determines stays as it is
 * in the guess.
 * \param[in] guesses of T_then_now: the best is taken
 * \return T_then_now, sensor frames */
Eigen::Isometry3d alignBody (const BodySightings& body, const std::vector<Eigen::Isometry3d>& guesses);

} // namespace pcl::cosection
