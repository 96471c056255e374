// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sensor_view.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief A box about each object, by label, that has what is near it. */
using Surroundings = std::map<std::uint32_t, Eigen::AlignedBox3f>;

Surroundings surroundingsOf (const Members& members, const SensorCloud& cloud);

/** \brief The background near objects, and the rest, which may be of a scale that says nothing about what is near. */
struct BackgroundParts
{
  std::vector<std::size_t> near, far;
};

BackgroundParts partsOfBackground (const Surroundings& objects, const Members& members, const SensorCloud& cloud);

} // namespace pcl::cosection
