// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "outlier_points.h"

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/occupied_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double patch_share = 0.01;     // of the points: as many, or ...
constexpr std::size_t patch_points = 50; // ... so many are no outliers

} // namespace

std::vector<bool>
findOutlierPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle, double reach_m)
{
  OccupiedCells cells;
  constexpr std::size_t nowhere = ~std::size_t (0);
  std::vector<std::size_t> cell_of (points.size (), nowhere);
  std::size_t last = nowhere; // points come in rows: most are in the cell of the one before
  Eigen::Array3d corner = Eigen::Array3d::Constant (std::numeric_limits<double>::quiet_NaN ()); // of that cell
  const double per_reach = 1.0 / reach_m;
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    const Eigen::Array3d at = (points[p].position.cast<double> () - middle).array () * per_reach;
    if (!((at >= corner).all () && (at < corner + 1.0).all ()))
    {
      const auto place = cellOf (at.matrix ());
      if (!place)
        continue;
      last = cells.add (*place);
      corner = place->cast<double> ().array ();
    }
    cell_of[p] = last;
  }
  DisjointSets patches (cells.size ());
  for (std::size_t c = 0; c < cells.size (); ++c)
    cells.forNeighbours (c, [&] (std::size_t neighbour) { patches.unite (c, neighbour); });
  std::vector<std::size_t> count (cells.size (), 0); // of points, by cell
  for (const std::size_t c : cell_of)
    if (c != nowhere)
      ++count[c];
  std::vector<std::size_t> size (cells.size (), 0); // by patch
  for (std::size_t c = 0; c < cells.size (); ++c)
    size[patches.find (c)] += count[c];
  const std::size_t enough = std::min (
      patch_points, static_cast<std::size_t> (std::ceil (patch_share * static_cast<double> (points.size ()))));
  std::vector<bool> lonely (cells.size ());
  for (std::size_t c = 0; c < cells.size (); ++c)
    lonely[c] = size[patches.find (c)] < enough;
  std::vector<bool> outlier (points.size ());
  for (std::size_t p = 0; p < points.size (); ++p)
    outlier[p] = cell_of[p] == nowhere || lonely[cell_of[p]];
  return outlier;
}

} // namespace pcl::cosection
