// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "extent_prior.h"

#include "pcl_cosection/priors/shape/principal_axes.h"

#include "extent_bounds.h"
#include "pcl_cosection/common/quantile.h"

#include "pcl_cosection/common/parallel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
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
  return farthest (observedExtents (points));
}

double
ExtentPrior::farthest (const Eigen::Vector3d& extents_m) const
{
  return std::max ({depth_factor, occluded_factor, side_factor}) * extents_m[1];
}

std::vector<float>
ExtentPrior::bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                     const std::vector<OrientedPoint>& points,
                     const std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>& views, int threads,
                     const std::vector<SymmetricExtent>& plausible) const
{
  OcclusionMap places;
  places.add (views, points, threads);
  return extentBounds (*this, grid, data_distance_vox, observedExtents (points, threads), places, plausible, {},
                       threads);
}

} // namespace pcl::cosection
