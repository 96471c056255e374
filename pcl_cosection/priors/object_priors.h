// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "observation.h"
#include "pcl_cosection/energy/body_energy.h"

#include <optional>
#include <vector>

namespace pcl::cosection {

// The priors of an object: what is expected where nothing was measured and no constraint decides. All effects of priors
// on a completion go through these four functions. Planes are n.x + d = 0, unit n towards the object, in its frame.

/** \brief The wall thickness of an object that is hollow and open, metres; 0 for other shapes.
 * \param[in] planes on which it may stand */
double wallThickness (const Observation& object, const ObjectSetting& setting,
                      const std::vector<Eigen::Vector4d>& planes);

/** \brief The support plane that the points of an object without known surroundings suggest; nothing if they suggest no
 * plane. */
std::optional<Eigen::Vector4d> inferSupportPlane (const Observation& object, const ObjectSetting& setting);

/** \brief Box of the points and, where something else hides them, of their projections onto the planes. */
Eigen::AlignedBox3d boxDownToPlanes (const Observation& object, const ObjectSetting& setting,
                                     const std::vector<Eigen::Vector4d>& planes);

/** \brief Add the terms of all priors that the options enable to an object's energy.
 * \param[in] planes on which it may stand
 * \param[in] plane_is_inferred the only plane is that of inferSupportPlane ()
 * \param[in,out] hidden occlusion of the object's volume by its views */
void addPriors (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
                bool plane_is_inferred, OcclusionMap& hidden, BodyEnergy& energy);

} // namespace pcl::cosection
