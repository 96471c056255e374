// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_energy.h"

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief What the measurements alone say of a body's shape. */
struct MeasuredShape
{
  /** \brief Voxels: near points, the signed distance from the surface through them; elsewhere the distance to the
   * border of what was seen free, negative where nothing was seen. */
  SignedDistanceField field;
  std::vector<std::uint8_t> known; ///< 1 where seen free, and around points but not behind them
};

/** \param[in] energy with data term and free space, before any prior */
MeasuredShape measuredShape (const BodyEnergy& energy);

} // namespace pcl::cosection
