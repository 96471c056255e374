// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "observation.h"
#include "pcl_cosection/energy/body_energy.h"

#include <optional>
#include <vector>

namespace pcl::cosection
{

// What is expected of an object where nothing was measured and no constraint decides. Everything that priors do to a
// completion goes through these four functions. Planes are n.x + d = 0, unit n towards the object, in its frame.

/** \brief The wall thickness of an object that is hollow and open, metres; 0 for other shapes.
 * \param[in] planes on which it may stand */
double wallThickness (const Observation& object, const ObjectSetting& setting,
                      const std::vector<Eigen::Vector4d>& planes);

/** \brief The plane on which an object around which nothing is known seems to have stood; nothing where its points do
 * not suggest one. */
std::optional<Eigen::Vector4d> inferSupportPlane (const Observation& object, const ObjectSetting& setting);

/** \brief Box of what was observed and, where something else hides it, of what is straight below it on the planes. */
Eigen::AlignedBox3d boxDownToPlanes (const Observation& object, const ObjectSetting& setting,
                                     const std::vector<Eigen::Vector4d>& planes);

/** \brief Add the terms of all priors that the options switch on to an object's energy.
 * \param[in] planes on which it may stand
 * \param[in] plane_is_inferred the only plane is that of inferSupportPlane ()
 * \param[in,out] hidden what the views hide of the object */
void addPriors (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
                bool plane_is_inferred, OcclusionMap& hidden, BodyEnergy& energy);

} // namespace pcl::cosection
