// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_priors.h"

#include "pcl_cosection/common/plane_height.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

// On which planes an object rests. Planes are n.x + d = 0, unit n towards the object, in its frame.

constexpr double lowest_share = 0.01; // of an object's points: outliers among the lowest ones

/** \brief The plane nearest to the object's middle of those that its lowest points come near to. */
std::optional<Eigen::Vector4d> nearestPlaneBelow (const Observation& object,
                                                  const std::vector<Eigen::Vector4d>& planes);

/** \brief The planes on which the object rests in some view: those that its lowest points come near to, and those to
 * which nothing shows that it does not reach. Of parallel ones, the nearest. */
std::vector<Eigen::Vector4d> restingPlanes (const Observation& object, const ObjectSetting& setting,
                                            const std::vector<Eigen::Vector4d>& planes, const BodyEnergy& energy);

/** \brief The plane of a level top of another object, if an object stands on it: the top is at the height of the
 * object's lowest points, on all sides of its middle. All in one frame, e.g. the world's.
 * \param[in] object, other their points \param[in] below a plane that supports both
 * \param[in] tolerance_m of heights */
std::optional<Eigen::Vector4d> levelTopBelow (const std::vector<OrientedPoint>& object,
                                              const std::vector<OrientedPoint>& other, const Eigen::Vector4d& below,
                                              double tolerance_m);

/** \brief Box of the points and of their feet on the planes where these are hidden. Of parallel planes, the nearest
 * counts. */
Eigen::AlignedBox3d boxWithFeet (const Observation& object, const ObjectSetting& setting,
                                 const std::vector<Eigen::Vector4d>& planes);

} // namespace pcl::cosection
