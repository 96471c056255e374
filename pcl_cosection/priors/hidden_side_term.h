// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_energy.h"
#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <pcl/cosection/common/oriented_point.h>

#include <vector>

namespace pcl::cosection {

/** \brief Add a weak data term for the expected hidden side: signed distances from copies of the points, at voxels
 * without data that were not seen free.
 *
 * The data of the two sides of a vessel's wall overlap and blur each other. So both sides have separate signed
 * distances, measured or else expected; the wall is their intersection, and nowhere much thinner than its mean
 * thickness, as noise would make holes. The cavity is expected to be empty.
 * \param[in,out] energy already with its data term; measured targets at the walls of vessels are replaced
 * \param[in] points all measured points */
void addHiddenSide (BodyEnergy& energy, const ProfiledShape& shape, const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
