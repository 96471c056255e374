// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "residual_clusters.h"

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/occupied_cells.h"

#include <cstddef>
#include <optional>

namespace pcl::cosection {
namespace {

/** \brief Numbers of points in a cell. */
struct Counts
{
  std::size_t left = 0;
  std::size_t taken = 0;
};

} // namespace

void
addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken)
{
  OccupiedCells occupied;
  std::vector<Counts> cells;
  std::vector<std::optional<std::size_t>> cell_of (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    if (const auto place = cellOf (points[p].position.cast<double> () / cell_m))
    {
      const std::size_t cell = occupied.add (*place);
      cells.resize (occupied.size ());
      cell_of[p] = cell;
      ++(taken[p] ? cells[cell].taken : cells[cell].left);
    }

  DisjointSets patches (cells.size ());
  std::vector<std::vector<std::size_t>> neighbours (
      cells.size ()); // of cells with points that are left; itself among them
  for (std::size_t c = 0; c < cells.size (); ++c)
    if (cells[c].left > 0)
      occupied.forNeighbours (c, [&] (std::size_t neighbour) {
        neighbours[c].push_back (neighbour);
        if (cells[neighbour].left > 0)
          patches.unite (c, neighbour);
      });
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
