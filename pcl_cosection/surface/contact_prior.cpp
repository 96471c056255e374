// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/contact_prior.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double contact_outliers = 0.02; // share of the contacts, at either side
constexpr int closing_cells = 3;          // gaps between points up to twice this wide are closed

/** \brief A bitmap on the plane, in cells of one voxel. */
class PlaneMap
{
public:
  PlaneMap (const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell)
  : low_ (low - Eigen::Vector2d::Constant (margin_cells * cell))
  , cell_ (cell)
  , width_ (static_cast<int> ((high.x () - low.x ()) / cell) + 2 * margin_cells + 1)
  , height_ (static_cast<int> ((high.y () - low.y ()) / cell) + 2 * margin_cells + 1)
  , cells_ (static_cast<std::size_t> (width_) * height_, 0)
  {}

  void
  set (const Eigen::Vector2d& p)
  {
    cells_[index (p)] = 1;
  }

  bool
  at (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return q.x () >= 0.0 && q.y () >= 0.0 && q.x () < width_ && q.y () < height_ && cells_[index (p)] != 0;
  }

  void
  close (int radius)
  {
    spread (radius, 1);
    spread (radius, 0);
  }

private:
  static constexpr int margin_cells = closing_cells + 1;

  std::size_t
  index (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return static_cast<std::size_t> (q.y ()) * width_ + static_cast<std::size_t> (q.x ());
  }

  /** \brief Give cells within \a radius (square) of one of \a value that value. */
  void
  spread (int radius, std::uint8_t value)
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
            if (i >= 0 && j >= 0 && i < width_ && j < height_ && before[static_cast<std::size_t> (j) * width_ + i] == value)
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

} // namespace

std::vector<std::uint8_t>
ContactPrior::patch (const VoxelGrid& grid, const Eigen::Vector4d& plane, const std::vector<OrientedPoint>& points,
                     const Eigen::Vector3d& sensor_m, const std::vector<std::uint8_t>& free_space) const
{
  const double h = grid.voxel_size_m;
  const Eigen::Vector3d normal = plane.head<3> ();
  const auto height = [&] (const Eigen::Vector3d& p) { return normal.dot (p) + plane[3]; };

  // Axes in the plane: across and along the line of sight.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
  for (const OrientedPoint& p : points)
    middle += p.position.cast<double> () / static_cast<double> (points.size ());
  Eigen::Vector3d along = middle - sensor_m;
  along -= normal.dot (along) * normal;
  if (along.norm () < 1e-9) // seen from straight above: any axis
    along = normal.unitOrthogonal ();
  along.normalize ();
  const Eigen::Vector3d across = normal.cross (along);
  const auto flat = [&] (const Eigen::Vector3d& p) { return Eigen::Vector2d (across.dot (p), along.dot (p)); };

  std::vector<double> contacts, depths;
  std::vector<Eigen::Vector2d> above;
  Eigen::Vector2d low = Eigen::Vector2d::Constant (1e30);
  Eigen::Vector2d high = Eigen::Vector2d::Constant (-1e30);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    const Eigen::Vector3d voxel = grid.toVoxel (p);
    if ((voxel.array () < 0.0).any () || (voxel.array () >= grid.dims.cast<double> ().array ()).any ())
      continue;
    const double z = height (p);
    if (std::abs (z) <= contact_height_vox * h)
    {
      contacts.push_back (across.dot (p));
      depths.push_back (along.dot (p));
    }
    if (z > 0.0)
    {
      above.push_back (flat (p));
      low = low.cwiseMin (above.back ());
      high = high.cwiseMax (above.back ());
    }
  }
  if (static_cast<int> (contacts.size ()) < min_contacts || above.empty ())
    return {};
  std::sort (contacts.begin (), contacts.end ());
  const auto cut = static_cast<std::size_t> (contact_outliers * static_cast<double> (contacts.size ()));
  const double left = contacts[cut];
  const double right = contacts[contacts.size () - 1 - cut];
  std::sort (depths.begin (), depths.end ());
  const double back = depths[depths.size () - 1 - cut] + depth_per_width * (right - left);

  PlaneMap covered (low, high, h);
  for (const Eigen::Vector2d& p : above)
    covered.set (p);
  covered.close (closing_cells);

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
        patch[n] = q.x () >= left && q.x () <= right && q.y () <= back && covered.at (q);
      }
  return patch;
}

} // namespace cosection
} // namespace pcl
