// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

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

/** \brief The cells of a lattice that something is in, numbered in the order in which they were added. */
class OccupiedCells
{
public:
  /** \return the cell's number, a new one if it was not there */
  std::size_t add (const CellIndex& cell)
  {
    const auto [entry, fresh] = numbers_.emplace (keyOf (cell), cells_.size ());
    if (fresh)
      cells_.push_back (cell);
    return entry->second;
  }

  std::size_t size () const { return cells_.size (); }

  /** \brief Call \a visit (number) for the cell of that number and its occupied neighbours, at most 27. */
  template <typename Visit> void forNeighbours (std::size_t number, Visit&& visit) const
  {
    for (int n = 0; n < 27; ++n)
      if (const auto entry = numbers_.find (keyOf (neighbourOf (cells_[number], n))); entry != numbers_.end ())
        visit (entry->second);
  }

private:
  std::unordered_map<std::uint64_t, std::size_t> numbers_; // by key
  std::vector<CellIndex> cells_;
};

} // namespace pcl::cosection
