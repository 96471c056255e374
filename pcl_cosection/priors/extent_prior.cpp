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
  return bounds (grid, data_distance_vox, observedExtents (points, threads), {views, points, threads}, {}, threads);
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const Eigen::Vector3d& extents_m, const OcclusionMap& places,
                     const std::vector<std::uint8_t>& exempt, int threads) const
{
  const Eigen::Vector3d extents_vox = extents_m / grid.voxel_size_m;
  const float unquestioned = std::min ({allowed (extents_vox, Hidden::ByObject), allowed (extents_vox, Hidden::ByOther),
                                        allowed (extents_vox, Hidden::Nothing)});
  std::vector<std::uint8_t> wanted (grid.size ());
  for (std::size_t n = 0; n < wanted.size (); ++n)
    wanted[n] = data_distance_vox[n] > unquestioned && (exempt.empty () || !exempt[n]);
  const std::vector<Hidden> hidden = places.ofVoxels (grid, wanted, threads);
  std::vector<float> bounds (grid.size (), 0.0f);
  for (std::size_t n = 0; n < wanted.size (); ++n)
    if (wanted[n])
      bounds[n] = std::max (0.0f, data_distance_vox[n] - allowed (extents_vox, hidden[n]));
  return bounds;
}

} // namespace pcl::cosection
