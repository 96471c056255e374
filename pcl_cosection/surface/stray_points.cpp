// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "stray_points.h"

#include "../common/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double patch_share = 0.01;      // of the points: as many, or ...
constexpr std::size_t patch_points = 50;  // ... so many are no strays
constexpr int cell_bits = 21;

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

std::uint64_t
keyOf (const Cell& cell)
{
  constexpr std::uint64_t mask = (std::uint64_t{1} << cell_bits) - 1;
  return (static_cast<std::uint64_t> (cell.z ()) & mask) << 2 * cell_bits |
         (static_cast<std::uint64_t> (cell.y ()) & mask) << cell_bits | (static_cast<std::uint64_t> (cell.x ()) & mask);
}

} // namespace

std::vector<bool>
findStrayPoints (const std::vector<OrientedPoint>& points, double reach_m)
{
  std::unordered_map<std::uint64_t, std::size_t> cells; // number of each that has points
  std::vector<Cell> places;
  std::vector<std::size_t> cell_of (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    const Cell place = (points[p].position.cast<double> () / reach_m).array ().floor ().cast<std::int64_t> ();
    const auto [entry, fresh] = cells.emplace (keyOf (place), places.size ());
    if (fresh)
      places.push_back (place);
    cell_of[p] = entry->second;
  }
  DisjointSets patches (places.size ());
  for (std::size_t c = 0; c < places.size (); ++c)
    for (int n = 0; n < 27; ++n)
    {
      const auto neighbour = cells.find (keyOf (places[c] + Cell (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (neighbour != cells.end ())
        patches.unite (c, neighbour->second);
    }
  std::vector<std::size_t> size (places.size (), 0);
  for (const std::size_t c : cell_of)
    ++size[patches.find (c)];
  const std::size_t enough =
      std::min (patch_points, static_cast<std::size_t> (std::ceil (patch_share * static_cast<double> (points.size ()))));
  std::vector<bool> stray (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    stray[p] = size[patches.find (cell_of[p])] < enough;
  return stray;
}

} // namespace cosection
} // namespace pcl
