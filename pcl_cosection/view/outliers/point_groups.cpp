// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "point_groups.h"

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/occupied_cells.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int cells = 16;            // along the longest side; points in neighbouring cells are of one group
constexpr double least_share = 0.05; // of the points, in a group

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

double
gapBetweenGroups (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  if (points.empty () || !(box.sizes ().maxCoeff () > 0.0))
    return 0.0;
  const double per_metre = cells / box.sizes ().maxCoeff ();
  OccupiedCells occupied;
  std::vector<Group> groups; // by cell, later by the first cell of each
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if (!box.contains (p))
      continue;
    const Eigen::Vector3i at = ((p - box.min ()) * per_metre).cast<int> ().cwiseMin (cells - 1);
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
                                             least_share * static_cast<double> (points.size ()) ||
                                         group.points == 0;
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

} // namespace pcl::cosection
