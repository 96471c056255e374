// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "contact_prior.h"

#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/priors/shape/principal_axes.h"

#include "pcl_cosection/energy/constraints/plane_map.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection
{

namespace
{

constexpr int least_part_cells = 4;     // of a part of the contact; smaller ones are outliers
constexpr double lowest_free_vox = 3.0; // over the plane: lower free space cannot be distinguished from the plane
constexpr double highest_free_vox = 7.0;
constexpr int closing_cells = 3; // gaps between points up to twice this wide are closed

} // namespace

std::vector<std::uint8_t>
ContactPrior::patch (const VoxelGrid& grid, const Eigen::Vector4d& plane, const std::vector<OrientedPoint>& points,
                     const Eigen::Vector3d& center, const std::vector<std::uint8_t>& free_space) const
{
  const double h = grid.voxel_size_m;
  const Eigen::Vector3d normal = plane.head<3> ();
  const auto height = [&] (const Eigen::Vector3d& p) { return normal.dot (p) + plane[3]; };
  const Eigen::Matrix3d axes = principalAxes (points, normal);
  const Eigen::Vector3d across = axes.col (0);
  const Eigen::Vector3d along = axes.col (1);
  const auto flat = [&] (const Eigen::Vector3d& p) { return Eigen::Vector2d (across.dot (p), along.dot (p)); };
  const Eigen::Vector2d middle = flat (center);
  const auto turned = [&] (const Eigen::Vector2d& p) { return Eigen::Vector2d (2.0 * middle - p); };

  std::vector<Eigen::Vector2d> contacts, above;
  above.reserve (points.size ());
  Eigen::Vector2d low = Eigen::Vector2d::Constant (1e30);
  Eigen::Vector2d high = Eigen::Vector2d::Constant (-1e30);
  const Eigen::Array3d begin = grid.origin_m.array ();
  const Eigen::Array3d end = begin + h * grid.dims.cast<double> ().array ();
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if ((p.array () < begin).any () || (p.array () >= end).any ())
      continue;
    const double z = height (p);
    if (std::abs (z) <= contact_height_vox * h && std::abs (normal.dot (point.normal.cast<double> ())) < max_slope)
      contacts.push_back (flat (p));
    if (z > 0.0)
    {
      above.push_back (flat (p));
      low = low.cwiseMin (above.back ());
      high = high.cwiseMax (above.back ());
    }
  }
  if (static_cast<int> (contacts.size ()) < min_contacts || above.empty ())
    return {};
  // The middle is the centre of a cell, so that the map does not depend on the sense of the axes.
  const Eigen::Vector2d reach = (high - middle).cwiseMax (middle - low); // of the points above and their turned copies
  const Eigen::Vector2d half = ((reach.array () / h).ceil () + 0.5) * h;
  low = middle - half;
  high = middle + half;
  PlaneMap covered (low, high, h, closing_cells + 1);
  for (const Eigen::Vector2d& p : above)
  {
    covered.set (p);
    covered.set (turned (p));
  }
  covered.close (closing_cells);

  PlaneMap touched (low, high, h, closing_cells + 1);
  for (const Eigen::Vector2d& p : contacts)
    touched.set (p);
  touched.close (closing_cells);
  // The share seen free of the space over a polygon, close to the plane and below observed surface or its copy.
  const auto seenFree = [&] (const std::vector<Eigen::Vector2d>& polygon) {
    std::size_t all = 0, free = 0;
    for (int k = 0; k < grid.dims.z (); ++k)
      for (int j = 0; j < grid.dims.y (); ++j)
        for (int i = 0; i < grid.dims.x (); ++i)
        {
          const Eigen::Vector3d p = grid.center (i, j, k);
          if (height (p) < lowest_free_vox * h || height (p) > highest_free_vox * h)
            continue;
          const Eigen::Vector2d q = flat (p);
          if (!covered.at (q) || !isInside (polygon, q))
            continue;
          ++all;
          free += static_cast<std::size_t> (free_space[grid.index (i, j, k)] != 0);
        }
    return all == 0 ? 0.0 : static_cast<double> (free) / static_cast<double> (all);
  };
  std::vector<std::vector<Eigen::Vector2d>> undersides;
  for (const std::vector<Eigen::Vector2d>& part : touched.parts ())
  {
    if (static_cast<int> (part.size ()) < least_part_cells)
      continue;
    double length = 0.0, gap = std::numeric_limits<double>::infinity ();
    for (const Eigen::Vector2d& a : part)
      for (const Eigen::Vector2d& b : part)
      {
        length = std::max (length, (a - b).norm ());
        gap = std::min (gap, (a - turned (b)).norm ());
      }
    const bool completed = gap <= gap_per_length * length;
    std::vector<Eigen::Vector2d> own, both; // corners a voxel around the centres, which may be collinear
    for (const Eigen::Vector2d& p : part)
      for (const Eigen::Vector2d& corner :
           {Eigen::Vector2d (-h, -h), Eigen::Vector2d (h, -h), Eigen::Vector2d (-h, h), Eigen::Vector2d (h, h)})
      {
        own.emplace_back (p + corner);
        both.emplace_back (p + corner);
        both.emplace_back (turned (p) + corner);
      }
    both = convexHull (std::move (both));
    undersides.push_back (completed && seenFree (both) < max_free_share ? both : convexHull (std::move (own)));
  }

  std::vector<std::uint8_t> patch (grid.size (), 0);
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const Eigen::Vector3d p = grid.center (i, j, k);
        if (std::abs (height (p)) > reach_vox * h || free_space[n])
          continue;
        const Eigen::Vector2d q = flat (p);
        patch[n] = covered.at (q) && std::any_of (undersides.begin (), undersides.end (),
                                                  [&] (const auto& hull) { return isInside (hull, q); });
      }
  return patch;
}

} // namespace pcl::cosection
