// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_energy.h"
#include "pcl_cosection/priors/proposal.h"
#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <pcl/cosection/common/oriented_point.h>

#include <vector>

namespace pcl::cosection {

/** \brief Add the term of a vessel: signed distances from its wall, measured or else expected, at voxels that were not
 * seen free.
 *
 * The data of the two sides of its wall overlap and blur each other. So all parts of its surface have separate signed
 * distances; the wall is the intersection of their insides, whose signed distance is the largest of them, and nowhere
 * much thinner than its mean thickness, as noise would make holes. The cavity is expected to be empty.
 * \param[in,out] energy already with its data term; measured targets at the wall are replaced
 * \param[in] measured all points
 * \param[in,out] proposal bounded beyond the vessel's convex hull */
void addVessel (BodyEnergy& energy, const ProfiledShape& shape, const std::vector<OrientedPoint>& measured,
                Proposal& proposal);

} // namespace pcl::cosection
