// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief How many points the levels of a coarse-to-fine search may have. */
struct LevelSizes
{
  int levels = 1;
  int min_points = 1; ///< of a level that is not the last
  int max_points = 0; ///< of the last; 0: all
};

/** \brief Weighted points, component by component, in an order in which the first so many are an even sample of all. */
class PointLevels
{
public:
  std::vector<float> x, y, z, weight;
  std::vector<std::size_t> ends; ///< of the levels, coarse to fine; empty without points

  /** \brief Take the finite points of positive weight. Vectors keep their memory.
   * \param[in] weights one per point, or none: 1 */
  void assign (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights, const LevelSizes& sizes);

  std::size_t size () const { return ends.empty () ? 0 : ends.back (); }

private:
  std::vector<std::uint8_t> level_; // of each point of the input
};

} // namespace pcl::cosection
