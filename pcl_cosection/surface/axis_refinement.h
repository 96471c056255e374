// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief The axis about which points lie on circles: normals find it, positions tell more precisely where it is.
 *
 * Least squares of the points' distances from their profiles, which are straight in each of some bands of height, one of the outer and one of
 * the inner side; Gauss-Newton with Cauchy weights, as what sticks out is no part of the profile.
 * \param[in] turn also change the direction */
Axis
refineAxis (const Axis& axis, const std::vector<NormalLine>& lines, bool turn);

} // namespace cosection
} // namespace pcl
