// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "stray_points.h"

#include "../common/cell_key.h"
#include "../common/disjoint_sets.h"

#include <algorithm>
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
} // namespace

std::vector<bool>
findStrayPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle, double reach_m)
{
  std::unordered_map<std::uint64_t, std::size_t> cells; // number of each that has points
  std::vector<CellIndex> places;
  constexpr std::size_t nowhere = ~std::size_t (0);
  std::vector<std::size_t> cell_of (points.size (), nowhere);
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    const auto place = cellOf ((points[p].position.cast<double> () - middle) / reach_m);
    if (!place)
      continue;
    const auto [entry, fresh] = cells.emplace (keyOf (*place), places.size ());
    if (fresh)
      places.push_back (*place);
    cell_of[p] = entry->second;
  }
  DisjointSets patches (places.size ());
  for (std::size_t c = 0; c < places.size (); ++c)
    for (int n = 0; n < 27; ++n)
    {
      const auto neighbour = cells.find (keyOf (places[c] + CellIndex (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (neighbour != cells.end ())
        patches.unite (c, neighbour->second);
    }
  std::vector<std::size_t> size (places.size (), 0);
  for (const std::size_t c : cell_of)
    if (c != nowhere)
      ++size[patches.find (c)];
  const std::size_t enough =
      std::min (patch_points, static_cast<std::size_t> (std::ceil (patch_share * static_cast<double> (points.size ()))));
  std::vector<bool> stray (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    stray[p] = cell_of[p] == nowhere || size[patches.find (cell_of[p])] < enough;
  return stray;
}

} // namespace cosection
} // namespace pcl
