// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace pcl::cosection {

/** \brief Cells of a lattice without borders, as keys of a hash table. */
using CellIndex = Eigen::Matrix<std::int64_t, 3, 1>;

constexpr double farthest_cell = 1 << 20; ///< along each axis, on either side

/** \brief The cell of a place in units of cells; nothing if that is too far from the origin, or not finite. */
inline std::optional<CellIndex>
cellOf (const Eigen::Vector3d& place)
{
  if (!(place.cwiseAbs ().maxCoeff () < farthest_cell - 1.0) || !place.allFinite ())
    return std::nullopt;
  return CellIndex (place.array ().floor ().cast<std::int64_t> ());
}

/** \brief The cell \a n, from 0 to 26, of those that are at most one cell away along each axis; 13: itself. */
inline CellIndex
neighbourOf (const CellIndex& cell, int n)
{
  return cell + CellIndex (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
}

/** \brief A different number for each cell that is not farther away than farthest_cell. */
inline std::uint64_t
keyOf (const CellIndex& cell)
{
  constexpr int bits = 21;
  constexpr std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  return (static_cast<std::uint64_t> (cell.z ()) & mask) << 2 * bits |
         (static_cast<std::uint64_t> (cell.y ()) & mask) << bits | (static_cast<std::uint64_t> (cell.x ()) & mask);
}

} // namespace pcl::cosection
