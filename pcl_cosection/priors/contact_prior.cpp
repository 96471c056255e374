// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "contact_prior.h"

#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/priors/shape/axes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double contact_height_vox = 2.5; // largest distance of a contact point from the plane
constexpr double max_slope = 0.7;          // largest |n.plane| of the normal n of a contact point
constexpr double gap_per_length = 1.0;     // largest gap between a part and its copy, per length of the part
constexpr double max_free_share = 0.1;     // of the space between a part and its copy over the plane, seen free
constexpr std::size_t least_contacts = 10; // number of contact points
constexpr double patch_reach_vox = 2.0;    // voxels up to this height above or below the plane are affected
constexpr int least_part_cells = 4;        // of a part of the contact; smaller ones are outliers
constexpr double lowest_free_vox = 3.0;    // over the plane: lower free space cannot be distinguished from the plane
constexpr double highest_free_vox = 7.0;
constexpr int closing_cells = 3; // gaps between points up to twice this wide are closed

using Polygon = std::vector<Eigen::Vector2d>;

/** \brief A bitmap on a plane, whose cells are set by points. */
class PlaneMap
{
public:
  /** \param[in] margin cells beyond \a low and \a high, at least the radius of close () */
  PlaneMap (const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell, int margin)
      : low_ (low - Eigen::Vector2d::Constant (margin * cell))
      , cell_ (cell)
      , width_ (static_cast<int> ((high.x () - low.x ()) / cell) + 2 * margin + 1)
      , height_ (static_cast<int> ((high.y () - low.y ()) / cell) + 2 * margin + 1)
      , cells_ (static_cast<std::size_t> (width_) * height_, 0)
  {}

  void set (const Eigen::Vector2d& p) { cells_[index (p)] = 1; }

  bool at (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return q.x () >= 0.0 && q.y () >= 0.0 && q.x () < width_ && q.y () < height_ && cells_[index (p)] != 0;
  }

  /** \brief Fill gaps of up to twice \a radius cells. */
  void close (int radius)
  {
    spread (radius, 1);
    spread (radius, 0);
  }

  /** \brief Centres of the cells of each connected component. */
  std::vector<std::vector<Eigen::Vector2d>> parts () const
  {
    std::vector<std::vector<Eigen::Vector2d>> parts;
    std::vector<std::uint8_t> left = cells_;
    std::vector<std::size_t> open;
    for (std::size_t seed = 0; seed < left.size (); ++seed)
    {
      if (!left[seed])
        continue;
      left[seed] = 0;
      open.push_back (seed);
      parts.emplace_back ();
      while (!open.empty ())
      {
        const auto x = static_cast<int> (open.back () % width_);
        const auto y = static_cast<int> (open.back () / width_);
        open.pop_back ();
        parts.back ().emplace_back (low_ + cell_ * Eigen::Vector2d (x + 0.5, y + 0.5));
        for (int j = std::max (0, y - 1); j <= std::min (height_ - 1, y + 1); ++j)
          for (int i = std::max (0, x - 1); i <= std::min (width_ - 1, x + 1); ++i)
          {
            const std::size_t n = static_cast<std::size_t> (j) * width_ + i;
            if (!left[n])
              continue;
            left[n] = 0;
            open.push_back (n);
          }
      }
    }
    return parts;
  }

private:
  std::size_t index (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return static_cast<std::size_t> (q.y ()) * width_ + static_cast<std::size_t> (q.x ());
  }

  /** \brief Dilation of the cells that have \a value, with a square of \a radius cells. */
  void spread (int radius, std::uint8_t value)
  {
    for (const bool along_x : {true, false})
    {
      const std::vector<std::uint8_t> before = cells_;
      for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
          for (int r = -radius; r <= radius; ++r)
          {
            const int i = along_x ? x + r : x;
            const int j = along_x ? y : y + r;
            if (i >= 0 && j >= 0 && i < width_ && j < height_ &&
                before[static_cast<std::size_t> (j) * width_ + i] == value)
              cells_[static_cast<std::size_t> (y) * width_ + x] = value;
          }
    }
  }

  Eigen::Vector2d low_;
  double cell_;
  int width_;
  int height_;
  std::vector<std::uint8_t> cells_;
};

/** \brief Coordinates over a support plane, metres. */
struct PlaneFrame
{
  Eigen::Vector4d plane;
  Eigen::Vector3d across, along; // axes in the plane
  Eigen::Vector2d middle;        // of the object's axis

  double height (const Eigen::Vector3d& p) const { return plane.head<3> ().dot (p) + plane[3]; }

  Eigen::Vector2d flat (const Eigen::Vector3d& p) const { return {across.dot (p), along.dot (p)}; }

  /** \brief By half a revolution about the object's axis. */
  Eigen::Vector2d turned (const Eigen::Vector2d& p) const { return 2.0 * middle - p; }
};

/** \brief The points of contact, and the points above the plane, both in the plane. */
struct FlatPoints
{
  std::vector<Eigen::Vector2d> contacts, above;
};

FlatPoints
flatten (const VoxelGrid& grid, const PlaneFrame& frame, const std::vector<OrientedPoint>& points)
{
  const double h = grid.voxel_size_m;
  const Eigen::Vector3d normal = frame.plane.head<3> ();
  const Eigen::Array3d begin = grid.origin_m.array ();
  const Eigen::Array3d end = begin + h * grid.dims.cast<double> ().array ();
  FlatPoints flat;
  flat.above.reserve (points.size ());
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if ((p.array () < begin).any () || (p.array () >= end).any ())
      continue;
    const double z = frame.height (p);
    if (std::abs (z) <= contact_height_vox * h && std::abs (normal.dot (point.normal.cast<double> ())) < max_slope)
      flat.contacts.push_back (frame.flat (p));
    if (z > 0.0)
      flat.above.push_back (frame.flat (p));
  }
  return flat;
}

/** \brief The share seen free of the space over a polygon, close to the plane and below observed surface or its copy.
 */
double
freeShareOver (const Polygon& polygon, const VoxelGrid& grid, const PlaneFrame& frame, const PlaneMap& covered,
               const std::vector<std::uint8_t>& free_space)
{
  const double h = grid.voxel_size_m;
  std::size_t all = 0, free = 0;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3d p = grid.center (i, j, k);
        if (frame.height (p) < lowest_free_vox * h || frame.height (p) > highest_free_vox * h)
          continue;
        const Eigen::Vector2d q = frame.flat (p);
        if (!covered.at (q) || !isInside (polygon, q))
          continue;
        ++all;
        free += static_cast<std::size_t> (free_space[grid.index (i, j, k)] != 0);
      }
  return all == 0 ? 0.0 : static_cast<double> (free) / static_cast<double> (all);
}

/** \brief Whether a part of the contact and its turned copy are no farther apart than the part is long. */
bool
isNearItsCopy (const std::vector<Eigen::Vector2d>& part, const PlaneFrame& frame)
{
  double length = 0.0, gap = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector2d& a : part)
    for (const Eigen::Vector2d& b : part)
    {
      length = std::max (length, (a - b).norm ());
      gap = std::min (gap, (a - frame.turned (b)).norm ());
    }
  return gap <= gap_per_length * length;
}

} // namespace

std::vector<std::uint8_t>
contactPatch (const VoxelGrid& grid, const Eigen::Vector4d& plane, const std::vector<OrientedPoint>& points,
              const Eigen::Vector3d& center, const std::vector<std::uint8_t>& free_space)
{
  const double h = grid.voxel_size_m;
  const Eigen::Matrix3d axes = principalAxes (points, plane.head<3> ());
  PlaneFrame frame{plane, axes.col (0), axes.col (1), {}};
  frame.middle = frame.flat (center);
  const FlatPoints flat = flatten (grid, frame, points);
  if (flat.contacts.size () < least_contacts || flat.above.empty ())
    return {};
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : flat.above)
    box.extend (p);
  // The middle is the centre of a cell, so that the map does not depend on the sense of the axes.
  const Eigen::Vector2d& middle = frame.middle;
  const Eigen::Vector2d reach = (box.max () - middle).cwiseMax (middle - box.min ()); // of points and turned copies
  const Eigen::Vector2d half = ((reach.array () / h).ceil () + 0.5) * h;
  PlaneMap covered (middle - half, middle + half, h, closing_cells + 1), touched = covered;
  for (const Eigen::Vector2d& p : flat.above)
  {
    covered.set (p);
    covered.set (frame.turned (p));
  }
  covered.close (closing_cells);
  for (const Eigen::Vector2d& p : flat.contacts)
    touched.set (p);
  touched.close (closing_cells);

  std::vector<Polygon> undersides;
  for (const std::vector<Eigen::Vector2d>& part : touched.parts ())
  {
    if (static_cast<int> (part.size ()) < least_part_cells)
      continue;
    Polygon own, both; // corners a voxel around the centres, which may be collinear
    for (const Eigen::Vector2d& p : part)
      for (const Eigen::Vector2d& corner :
           {Eigen::Vector2d (-h, -h), Eigen::Vector2d (h, -h), Eigen::Vector2d (-h, h), Eigen::Vector2d (h, h)})
      {
        own.emplace_back (p + corner);
        both.emplace_back (p + corner);
        both.emplace_back (frame.turned (p) + corner);
      }
    both = convexHull (std::move (both));
    const bool completed = isNearItsCopy (part, frame) &&
                           freeShareOver (both, grid, frame, covered, free_space) < max_free_share;
    undersides.push_back (completed ? both : convexHull (std::move (own)));
  }

  std::vector<std::uint8_t> patch (grid.size (), 0);
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const Eigen::Vector3d p = grid.center (i, j, k);
        if (std::abs (frame.height (p)) > patch_reach_vox * h || free_space[n])
          continue;
        const Eigen::Vector2d q = frame.flat (p);
        patch[n] = covered.at (q) && std::any_of (undersides.begin (), undersides.end (),
                                                  [&] (const Polygon& hull) { return isInside (hull, q); });
      }
  return patch;
}

} // namespace pcl::cosection
