// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_axis.h"

#include <vector>

namespace pcl::cosection {

/** \brief Refine the position of an axis of revolution by the positions of points, which are more precise than the
 * normals that found it.
 *
 * Least squares of the points' distances from their profile, which is straight in each of some bands of height, with
 * one line for the outer and one for the inner side. Gauss-Newton with Cauchy weights, as protruding parts do not
 * belong to the profile. The direction is kept: for a ring, with its curved profile, normals determine it better. */
Axis refineAxis (const Axis& axis, const std::vector<NormalLine>& lines);

} // namespace pcl::cosection
