// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/extent_prior.h>

#include <pcl/cosection/common/parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
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

enum class Evidence
{
  None,
  Occluded,
  Behind,
};

/** \brief What a view says of voxels that it does not see free. The object's silhouette is kept as the
 * nearest depth of its points per cell of the image. */
class Silhouette
{
public:
  Silhouette (const DepthView& view, const Eigen::Isometry3d& T_grid_sensor, const std::vector<OrientedPoint>& points)
  : view_ (view)
  , T_sensor_grid_ (T_grid_sensor.inverse ())
  , width_ ((view.camera.width + mask_cell - 1) / mask_cell)
  , height_ ((view.camera.height + mask_cell - 1) / mask_cell)
  , depth_ (static_cast<std::size_t> (width_) * height_, std::numeric_limits<float>::infinity ())
  {
    int u = 0;
    int v = 0;
    for (const OrientedPoint& point : points)
    {
      const Eigen::Vector3d p = T_sensor_grid_ * point.position.cast<double> ();
      if (!find (p, u, v))
        continue;
      float& nearest = depth_[static_cast<std::size_t> (v / mask_cell) * width_ + u / mask_cell];
      nearest = std::min (nearest, static_cast<float> (p.z ()));
    }
  }

  Evidence
  at (const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3d q = T_sensor_grid_ * p;
    int u = 0;
    int v = 0;
    if (!find (q, u, v))
      return Evidence::None;
    if (q.z () > depth_[static_cast<std::size_t> (v / mask_cell) * width_ + u / mask_cell])
      return Evidence::Behind;
    return q.z () > view_.at (u, v) ? Evidence::Occluded : Evidence::None; // no reading: not a number
  }

private:
  bool
  find (const Eigen::Vector3d& p, int& u, int& v) const
  {
    if (!(p.z () > 0.0))
      return false;
    const Eigen::Vector2d pixel = view_.camera.project (p) + Eigen::Vector2d::Constant (0.5);
    if (!(pixel.x () >= 0.0 && pixel.y () >= 0.0 && pixel.x () < view_.camera.width && pixel.y () < view_.camera.height))
      return false;
    u = static_cast<int> (pixel.x ());
    v = static_cast<int> (pixel.y ());
    return true;
  }

  const DepthView& view_;
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

ExtentPrior
ExtentPrior::cutOut ()
{
  ExtentPrior prior;
  prior.side_factor = 0.05;
  return prior;
}

double
ExtentPrior::farthest (const std::vector<OrientedPoint>& points) const
{
  return std::max ({depth_factor, occluded_factor, side_factor}) * observedExtents (points)[1];
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const std::vector<OrientedPoint>& points,
                     const std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>& views, int threads,
                     const std::vector<SymmetricExtent>& plausible) const
{
  std::vector<Silhouette> silhouettes;
  for (const auto& [view, T_grid_sensor] : views)
    silhouettes.emplace_back (*view, T_grid_sensor, points);
  const Eigen::Vector3d extents_vox = observedExtents (points) / grid.voxel_size_m;
  const auto margin_vox =
      static_cast<float> (std::max (symmetric_margin * extents_vox[1], least_depth * extents_vox[1] - extents_vox[2]));
  const auto allowed = [&] (Evidence evidence) {
    const double factor = evidence == Evidence::Behind     ? depth_factor
                          : evidence == Evidence::Occluded ? occluded_factor
                                                           : side_factor;
    return static_cast<float> (factor * extents_vox[1]);
  };
  const float unquestioned = std::min ({allowed (Evidence::Behind), allowed (Evidence::Occluded), allowed (Evidence::None)});

  std::vector<float> bounds (grid.size (), 0.0f);
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    const int width = grid.dims.x ();
    std::vector<float> beyond_vox (width, 0.0f), beyond_m (width);
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      if (!plausible.empty ())
        std::fill (beyond_vox.begin (), beyond_vox.end (), std::numeric_limits<float>::infinity ());
      for (const SymmetricExtent& extent : plausible)
      {
        extent.beyond (grid.center (0, j, k), grid.voxel_size_m * Eigen::Vector3d::UnitX (), width, beyond_m.data ());
        for (int i = 0; i < width; ++i)
          beyond_vox[i] = std::min (beyond_vox[i], static_cast<float> (beyond_m[i] / grid.voxel_size_m) - margin_vox);
      }
      for (int i = 0; i < width; ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        if (data_distance_vox[n] <= unquestioned && beyond_vox[i] <= 0.0f)
          continue;
        Evidence evidence = silhouettes.empty () ? Evidence::Behind : Evidence::None;
        for (const Silhouette& silhouette : silhouettes)
          evidence = std::max (evidence, silhouette.at (grid.center (i, j, k)));
        bounds[n] = std::max (0.0f, data_distance_vox[n] - allowed (evidence));
        if (evidence != Evidence::Occluded) // what hides a part hides how far it reaches
          bounds[n] = std::max (bounds[n], beyond_vox[i]);
      }
    }
  });
  return bounds;
}

} // namespace cosection
} // namespace pcl
