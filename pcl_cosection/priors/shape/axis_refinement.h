// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"

#include <vector>

namespace pcl::cosection
{

/** \brief The axis of a given direction about which points lie on circles: normals find it, positions tell more
 * precisely where it is.
 *
 * Least squares of the points' distances from their profiles, which are straight in each of some bands of height, one
 * of the outer and one of the inner side; Gauss-Newton with Cauchy weights, as what sticks out is no part of the
 * profile. The direction stays: of a ring, whose profile is curved, positions tell it worse than normals. */
Axis refineAxis (const Axis& axis, const std::vector<NormalLine>& lines);

} // namespace pcl::cosection
