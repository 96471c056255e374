// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/cell_key.h"

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace pcl::cosection {

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
