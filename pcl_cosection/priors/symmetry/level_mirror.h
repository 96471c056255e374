// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "copy_evidence.h"

#include <Eigen/Core>

#include <optional>

namespace pcl::cosection {

/** \brief The reflection in the level plane half way between the plane on which an object rests and its top: what lies
 * on a table often looks from below as it does from above. Most copies are hidden; the lower parts of its sides, as far
 * as they are visible, tell.
 * \param[in] plane unit normal towards the object, and offset
 * \return nothing if these parts do not confirm it */
std::optional<Eigen::Affine3d> findLevelMirror (const CopyJudge& judge, const Eigen::Vector4d& plane);

/** \brief Motions, each of them followed by a reflection, and that reflection. */
Motions unitedWith (const Eigen::Affine3d& mirror, Motions motions);

} // namespace pcl::cosection
