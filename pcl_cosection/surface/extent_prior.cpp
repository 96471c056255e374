// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/extent_prior.h>

#include <pcl/cosection/common/parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double low_percentile = 0.01;
constexpr double high_percentile = 0.99;
constexpr int mask_cell = 4; // pixels: the silhouette is kept at this resolution, which closes its pores

/** \brief Nearest depth of an object's points per cell of an image; infinity outside its silhouette. */
class Silhouette
{
public:
  Silhouette (const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor, const std::vector<OrientedPoint>& points)
  : camera_ (camera)
  , T_sensor_grid_ (T_grid_sensor.inverse ())
  , width_ ((camera.width + mask_cell - 1) / mask_cell)
  , height_ ((camera.height + mask_cell - 1) / mask_cell)
  , depth_ (static_cast<std::size_t> (width_) * height_, std::numeric_limits<float>::infinity ())
  {
    for (const OrientedPoint& point : points)
    {
      const Eigen::Vector3d p = T_sensor_grid_ * point.position.cast<double> ();
      int cell = 0;
      if (find (p, cell))
        depth_[cell] = std::min (depth_[cell], static_cast<float> (p.z ()));
    }
  }

  /** \brief True if \a p, in the grid's frame, lies behind an observed point. */
  bool
  hides (const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3d q = T_sensor_grid_ * p;
    int cell = 0;
    return find (q, cell) && q.z () > depth_[cell];
  }

private:
  bool
  find (const Eigen::Vector3d& p, int& cell) const
  {
    if (!(p.z () > 0.0))
      return false;
    const Eigen::Vector2d pixel = camera_.project (p) + Eigen::Vector2d::Constant (0.5);
    if (!(pixel.x () >= 0.0 && pixel.y () >= 0.0 && pixel.x () < camera_.width && pixel.y () < camera_.height))
      return false;
    cell = static_cast<int> (pixel.y ()) / mask_cell * width_ + static_cast<int> (pixel.x ()) / mask_cell;
    return true;
  }

  PinholeCamera camera_;
  Eigen::Isometry3d T_sensor_grid_;
  int width_;
  int height_;
  std::vector<float> depth_;
};

} // namespace

Eigen::Vector3d
observedExtents (const std::vector<OrientedPoint>& points)
{
  if (points.empty ())
    return Eigen::Vector3d::Zero ();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  for (const OrientedPoint& p : points)
    mean += p.position.cast<double> ();
  mean /= static_cast<double> (points.size ());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero ();
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d d = p.position.cast<double> () - mean;
    covariance += d * d.transpose ();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (covariance);
  Eigen::Vector3d extents;
  std::vector<double> along (points.size ());
  for (int a = 0; a < 3; ++a)
  {
    for (std::size_t n = 0; n < points.size (); ++n)
      along[n] = solver.eigenvectors ().col (a).dot (points[n].position.cast<double> () - mean);
    const auto percentile = [&] (double fraction) {
      const auto at = along.begin () + static_cast<std::ptrdiff_t> (fraction * static_cast<double> (along.size () - 1));
      std::nth_element (along.begin (), at, along.end ());
      return *at;
    };
    const double low = percentile (low_percentile);
    extents[a] = percentile (high_percentile) - low;
  }
  std::sort (extents.data (), extents.data () + 3, std::greater<> ());
  return extents;
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const std::vector<OrientedPoint>& points,
                     const std::vector<std::pair<PinholeCamera, Eigen::Isometry3d>>& views, int threads) const
{
  std::vector<Silhouette> silhouettes;
  for (const auto& [camera, T_grid_sensor] : views)
    silhouettes.emplace_back (camera, T_grid_sensor, points);
  const double extent_vox = observedExtents (points)[1] / grid.voxel_size_m;
  const auto side = static_cast<float> (side_factor * extent_vox);
  const auto depth = static_cast<float> (depth_factor * extent_vox);

  std::vector<float> bounds (grid.size (), 0.0f);
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        if (data_distance_vox[n] <= side)
          continue;
        const Eigen::Vector3d p = grid.center (i, j, k);
        const bool behind = silhouettes.empty () || std::any_of (silhouettes.begin (), silhouettes.end (),
                                                                 [&] (const Silhouette& s) { return s.hides (p); });
        bounds[n] = std::max (0.0f, data_distance_vox[n] - (behind ? depth : side));
      }
  });
  return bounds;
}

} // namespace cosection
} // namespace pcl
