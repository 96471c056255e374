// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "residual_clusters.h"

#include "pcl_cosection/common/cell_key.h"
#include "pcl_cosection/common/disjoint_sets.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace pcl::cosection
{

namespace
{

struct Cell
{
  CellIndex place;
  std::size_t left = 0;
  std::size_t taken = 0;
};

} // namespace

void
addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken)
{
  std::vector<Cell> cells;
  std::unordered_map<std::uint64_t, std::size_t> numbers;
  std::vector<std::optional<std::size_t>> cell_of (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    if (const auto place = cellOf (points[p].position.cast<double> () / cell_m))
    {
      const auto [entry, fresh] = numbers.emplace (keyOf (*place), cells.size ());
      if (fresh)
        cells.push_back ({*place});
      cell_of[p] = entry->second;
      ++(taken[p] ? cells[entry->second].taken : cells[entry->second].left);
    }

  DisjointSets patches (cells.size ());
  std::vector<std::vector<std::size_t>> neighbours (
      cells.size ()); // of cells with points that are left; itself among them
  for (std::size_t c = 0; c < cells.size (); ++c)
    for (int n = 0; cells[c].left > 0 && n < 27; ++n)
    {
      const auto neighbour = numbers.find (keyOf (cells[c].place + CellIndex (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (neighbour == numbers.end ())
        continue;
      neighbours[c].push_back (neighbour->second);
      if (cells[neighbour->second].left > 0)
        patches.unite (c, neighbour->second);
    }
  std::vector<std::size_t> left (cells.size (), 0), gone (cells.size (), 0); // by patch
  std::vector<std::size_t> counted_for (cells.size (),
                                        cells.size ()); // the patch that a cell has been counted for last
  std::vector<std::vector<std::size_t>> members (cells.size ());
  for (std::size_t c = 0; c < cells.size (); ++c)
    if (cells[c].left > 0)
      members[patches.find (c)].push_back (c);
  for (std::size_t patch = 0; patch < cells.size (); ++patch)
    for (const std::size_t c : members[patch])
    {
      left[patch] += cells[c].left;
      for (const std::size_t n : neighbours[c])
        if (counted_for[n] != patch)
        {
          counted_for[n] = patch;
          gone[patch] += cells[n].taken;
        }
    }
  for (std::size_t p = 0; p < points.size (); ++p)
    if (cell_of[p] && !taken[p])
    {
      const std::size_t patch = patches.find (*cell_of[p]);
      taken[p] = left[patch] < gone[patch];
    }
}

} // namespace pcl::cosection
