// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/object_priors.h"
#include "pcl_cosection/priors/proposal.h"
#include "symmetry_search.h"

namespace pcl::cosection {

/** \brief What motions that take a body to itself expect of the hidden parts of a body: observed surface where the
 * motions take it, nothing where they take free space, and nothing beyond the convex hull of the points and their
 * copies on sides of which one was seen.
 * \param[in] plane on which it stands, the grid's frame, or zeros */
void addCopies (const BodyEnergy& energy, const MeasuredShape& shape, const Motions& motions, const Observation& object,
                const Eigen::Vector4d& plane, Proposal& proposal);

} // namespace pcl::cosection
