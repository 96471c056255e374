// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace pcl::cosection {

/** \brief A measured point with its outward normal. */
struct OrientedPoint
{
  Eigen::Vector3f position;                       ///< metres
  Eigen::Vector3f normal;                         ///< unit, outward
  float weight = 1.0f;                            ///< association likelihood a_i in [0, 1] of the paper's data term
  std::array<std::uint8_t, 3> colour = {0, 0, 0}; ///< red, green, blue; black throughout: unknown
  float intensity = 0.0f;                         ///< any unit; not finite: unknown, 0 throughout: unknown
};

} // namespace pcl::cosection
