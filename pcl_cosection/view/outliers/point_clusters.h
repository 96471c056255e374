// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/lattice_cells.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <vector>

namespace pcl::cosection {

constexpr std::size_t no_patch = ~std::size_t (0); ///< of a point that is too far from the middle, or not finite

/** \brief The connected patch of each point. Points are connected if they are in the same cell of edge \a reach_m, or
 * in neighbouring ones.
 * \param[in] position (p): of the point \a p < \a count, metres
 * \param[in] middle of most points, metres
 * \return by point, a number less than \a count, or no_patch */
template <typename Position>
std::vector<std::size_t>
connectedPatches (std::size_t count, Position&& position, const Eigen::Vector3d& middle, double reach_m)
{
  OccupiedCells cells;
  std::vector<std::size_t> patch_of (count, no_patch); // first the cell
  std::size_t last = no_patch;                         // points come in rows: most are in the cell of the one before
  Eigen::Array3d corner = Eigen::Array3d::Constant (std::numeric_limits<double>::quiet_NaN ()); // of that cell
  const double per_reach = 1.0 / reach_m;
  for (std::size_t p = 0; p < count; ++p)
  {
    const Eigen::Array3d at = (position (p).template cast<double> () - middle).array () * per_reach;
    if (!((at >= corner).all () && (at < corner + 1.0).all ()))
    {
      const auto place = cellOf (at.matrix ());
      if (!place)
        continue;
      last = cells.add (*place);
      corner = place->template cast<double> ().array ();
    }
    patch_of[p] = last;
  }
  DisjointSets patches (cells.size ());
  for (std::size_t c = 0; c < cells.size (); ++c)
    cells.forNeighbours (c, [&] (std::size_t neighbour) { patches.unite (c, neighbour); });
  for (std::size_t& patch : patch_of)
    if (patch != no_patch)
      patch = patches.find (patch);
  return patch_of;
}

/** \brief Which points belong to no patch of some size: a few points far from all others, as wrong readings and wrong
 * labels leave, which would each become a body of its own. Points count as near if they are within about
 * \a reach_m of each other.
 * \param[in] middle of most points, metres
 * \return one value per point */
std::vector<bool> findOutlierPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle,
                                     double reach_m);

/** \brief How far groups of points are apart that are each smaller than that: those of one thing at two places.
 * \param[in] box of the points
 * \return metres; 0 if there are no such groups of a twentieth of the points at least */
double gapBetweenGroups (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box);

/** \brief Where points were taken away, take what is left of the same thing as well: patches that are connected over
 * cells of \a cell_m, and have fewer points than were taken from their cells and those beside. O (points).
 * \param[in,out] taken by point */
void addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken);

} // namespace pcl::cosection
