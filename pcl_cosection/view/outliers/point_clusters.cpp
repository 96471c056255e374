// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "point_clusters.h"

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/lattice_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double patch_share = 0.01;     // of the points: as many, or ...
constexpr std::size_t patch_points = 50; // ... so many are no outliers
constexpr int cells_across = 16;         // along the longest side; points in neighbouring cells are of one group
constexpr double least_share = 0.05;     // of the points, in a group

struct Group
{
  Eigen::AlignedBox3d box;
  std::size_t points = 0;
};

double
distanceBetween (const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
{
  return (a.min () - b.max ()).cwiseMax (b.min () - a.max ()).cwiseMax (0.0).norm ();
}

} // namespace

std::vector<bool>
findOutlierPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle, double reach_m)
{
  const std::vector<std::size_t> patch_of = connectedPatches (
      points.size (), [&] (std::size_t p) { return points[p].position; }, middle, reach_m);
  std::vector<std::size_t> size (points.size (), 0); // of patches, in points
  for (const std::size_t patch : patch_of)
    if (patch != no_patch)
      ++size[patch];
  const std::size_t enough = std::min (
      patch_points, static_cast<std::size_t> (std::ceil (patch_share * static_cast<double> (points.size ()))));
  std::vector<bool> outlier (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    outlier[p] = patch_of[p] == no_patch || size[patch_of[p]] < enough;
  return outlier;
}

double
gapBetweenGroups (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  if (points.empty () || !(box.sizes ().maxCoeff () > 0.0))
    return 0.0;
  const double per_metre = cells_across / box.sizes ().maxCoeff ();
  OccupiedCells occupied;
  std::vector<Group> groups; // by cell, later by the first cell of each
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if (!box.contains (p))
      continue;
    const Eigen::Vector3i at = ((p - box.min ()) * per_metre).cast<int> ().cwiseMin (cells_across - 1);
    const std::size_t cell = occupied.add (at.cast<std::int64_t> ());
    groups.resize (occupied.size ());
    groups[cell].box.extend (p);
    ++groups[cell].points;
  }
  DisjointSets sets (groups.size ());
  for (std::size_t c = 0; c < groups.size (); ++c)
    occupied.forNeighbours (c, [&] (std::size_t neighbour) { sets.unite (c, neighbour); });
  for (std::size_t c = 0; c < groups.size (); ++c)
    if (const std::size_t first = sets.find (c); first != c)
    {
      groups[first].box.extend (groups[c].box);
      groups[first].points += groups[c].points;
      groups[c] = Group ();
    }
  groups.erase (std::remove_if (groups.begin (), groups.end (),
                                [&] (const Group& group) {
                                  return static_cast<double> (group.points) <
                                         least_share * static_cast<double> (points.size ());
                                }),
                groups.end ());
  double largest_gap = 0.0;
  for (const Group& a : groups)
    for (const Group& b : groups)
      if (const double gap = distanceBetween (a.box, b.box);
          gap > std::max (a.box.sizes ().maxCoeff (), b.box.sizes ().maxCoeff ()))
        largest_gap = std::max (largest_gap, gap);
  return largest_gap;
}

void
addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken)
{
  OccupiedCells occupied;
  struct Counts
  {
    std::size_t left = 0, taken = 0;
  };
  std::vector<Counts> cells; // points in each
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
  std::vector<std::vector<std::size_t>> neighbours (cells.size ()); // of those with points left; themselves among them
  for (std::size_t c = 0; c < cells.size (); ++c)
    if (cells[c].left > 0)
      occupied.forNeighbours (c, [&] (std::size_t neighbour) {
        neighbours[c].push_back (neighbour);
        if (cells[neighbour].left > 0)
          patches.unite (c, neighbour);
      });
  std::vector<std::size_t> left (cells.size (), 0), gone (cells.size (), 0); // by patch
  std::vector<std::size_t> counted_for (cells.size (), cells.size ()); // the last patch that a cell was counted for
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
