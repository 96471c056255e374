// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "extent_prior.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"

#include <Eigen/Eigenvalues>

#include <functional>

namespace pcl::cosection {
namespace {

constexpr double low_percentile = 0.01;
constexpr double high_percentile = 0.99;

} // namespace

Eigen::Vector3d
observedExtents (const std::vector<OrientedPoint>& points, int threads)
{
  if (points.empty ())
    return Eigen::Vector3d::Zero ();
  const Scatter scatter = scatterOf (points);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (scatter.products);
  Eigen::Vector3d extents;
  parallelFor (0, 3, threads, [&] (int a) {
    std::vector<double> along (points.size ());
    const Eigen::Vector3d axis = solver.eigenvectors ().col (a);
    for (std::size_t n = 0; n < points.size (); ++n)
      along[n] = axis.dot (points[n].position.cast<double> () - scatter.mean);
    extents[a] = quantile (along, high_percentile) - quantile (along, low_percentile);
  });
  std::sort (extents.data (), extents.data () + 3, std::greater<> ());
  return extents;
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const std::vector<OrientedPoint>& points, const OcclusionMap::Views& views, int threads) const
{
  OcclusionMap places;
  places.add (views, points, threads);
  return bounds (grid, data_distance_vox, observedExtents (points, threads), places, {}, threads);
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const Eigen::Vector3d& extents_m, OcclusionMap& places, const std::vector<std::uint8_t>& exempt,
                     int threads) const
{
  const Eigen::Vector3d extents_vox = extents_m / grid.voxel_size_m;
  const auto allowed = [&] (Hidden hidden) {
    return static_cast<float> (allowedFactor (*this, hidden) * extents_vox[1]);
  };
  const float unquestioned = std::min (
      {allowed (Hidden::ByObject), allowed (Hidden::ByOther), allowed (Hidden::Nothing)});

  std::vector<float> bounds (grid.size (), 0.0f);
  const std::vector<VoxelTile> tiles = tilesOf (grid);
  places.begin (grid);
  parallelFor (0, static_cast<int> (tiles.size ()), threads, [&] (int t) {
    const VoxelTile& tile = tiles[t];
    const auto forEachVoxel = [&] (auto&& f) {
      std::size_t position = 0;
      for (int k = tile.first.z (); k < tile.end.z (); ++k)
        for (int j = tile.first.y (); j < tile.end.y (); ++j)
          for (int i = tile.first.x (); i < tile.end.x (); ++i, ++position)
            f (grid.index (i, j, k), position);
    };
    const Eigen::Vector3i size = tile.end - tile.first;
    std::vector<std::uint8_t> wanted (static_cast<std::size_t> (size.prod ()));
    forEachVoxel ([&] (std::size_t n, std::size_t position) {
      wanted[position] = data_distance_vox[n] > unquestioned && (exempt.empty () || !exempt[n]);
    });
    const std::vector<Hidden> hidden = places.find (tile, wanted);
    forEachVoxel ([&] (std::size_t n, std::size_t position) {
      if (wanted[position])
        bounds[n] = std::max (0.0f, data_distance_vox[n] - allowed (hidden[position]));
    });
  });
  places.end ();
  return bounds;
}

} // namespace pcl::cosection
