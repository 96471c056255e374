// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_priors.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The shape with a profile that an object's points show, standing on a plane if there is one; it is fitted
 * once. */
const ProfiledShape& shapeOf (const Observation& object, const ObjectSetting& setting,
                              const std::optional<Eigen::Vector4d>& plane);

/** \brief The shapes with a profile on the planes on which an object rests, or one without a plane. */
std::vector<ProfiledShape> profiledShapes (const Observation& object, const ObjectSetting& setting,
                                           const std::vector<Eigen::Vector4d>& resting);

} // namespace pcl::cosection
