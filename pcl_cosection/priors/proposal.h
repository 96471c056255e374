// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_energy.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief What a prior expects of a body where nothing was measured, by voxel of its grid. */
struct Proposal
{
  std::vector<float> target;           ///< signed distance, voxels, where there is a weight
  std::vector<float> weight;           ///< of the target; 0: none
  std::vector<float> least;            ///< lower bound of the signed distance, voxels; 0: none
  std::vector<std::uint8_t> surface;   ///< 1 where surface is expected
  std::vector<std::uint8_t> unbounded; ///< 1 where the object may be, however far from what was seen of it

  explicit Proposal (std::size_t voxels = 0)
      : target (voxels, 0.0f)
      , weight (voxels, 0.0f)
      , least (voxels, 0.0f)
      , surface (voxels, 0)
      , unbounded (voxels, 0)
  {}

  bool empty () const { return target.empty (); }

  /** \brief Whether matter may be at a voxel. */
  bool claims (std::size_t n) const { return unbounded[n] != 0 || (weight[n] > 0.0f && target[n] < 0.0f); }
};

} // namespace pcl::cosection
