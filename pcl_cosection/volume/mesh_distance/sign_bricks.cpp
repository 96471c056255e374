// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sign_bricks.h"

#include "brick_distances.h"

#include "pcl_cosection/common/multiversion.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::int32_t positive = 1;
constexpr std::int32_t not_positive = 2;

/** \brief Signs of the voxels of a row; NaN has no sign. */
PCL_COSECTION_MULTIVERSION void
addSigns (const float* __restrict values, int count, std::int32_t* __restrict signs)
{
  for (int i = 0; i < count; ++i)
    signs[i] |= (values[i] > 0.0f ? positive : 0) | (values[i] <= 0.0f ? not_positive : 0);
}

} // namespace

SignBricks::SignBricks (const SignedDistanceField& field, int threads)
    : dims_ ((field.grid.dims.array () + (edge - 2)) / edge) // cells are one fewer than voxels
    , last_voxel_ (field.grid.dims.cast<double> ().array () - 1.0)
{
  distances_ = brickDistances (findMixed (field, threads), dims_, max_distance);
}

std::vector<std::uint8_t>
SignBricks::findMixed (const SignedDistanceField& field, int threads) const
{
  const VoxelGrid& grid = field.grid;
  std::vector<std::uint8_t> mixed (static_cast<std::size_t> (dims_.x ()) * dims_.y () * dims_.z ());
  parallelFor (0, dims_.z (), threadsForVoxels (threads, grid.size ()), [&] (int bk) {
    std::vector<std::int32_t> signs (grid.dims.x ());
    for (int bj = 0; bj < dims_.y (); ++bj)
    {
      std::fill (signs.begin (), signs.end (), 0);
      for (int k = bk * edge; k <= std::min ((bk + 1) * edge, grid.dims.z () - 1); ++k)
        for (int j = bj * edge; j <= std::min ((bj + 1) * edge, grid.dims.y () - 1); ++j)
          addSigns (&field.values[grid.index (0, j, k)], grid.dims.x (), signs.data ());
      for (int bi = 0; bi < dims_.x (); ++bi)
      {
        std::int32_t both = 0;
        for (int i = bi * edge; i <= std::min ((bi + 1) * edge, grid.dims.x () - 1); ++i)
          both |= signs[i];
        mixed[index (bi, bj, bk)] = (both == (positive | not_positive));
      }
    }
  });
  return mixed;
}

std::array<Eigen::Vector3d, 2>
SignBricks::surfaceBox () const
{
  Eigen::Vector3i low = dims_;
  Eigen::Vector3i high = Eigen::Vector3i::Zero ();
  for (int k = 0; k < dims_.z (); ++k)
    for (int j = 0; j < dims_.y (); ++j)
      for (int i = 0; i < dims_.x (); ++i)
        if (distance (i, j, k) == 0)
        {
          low = low.cwiseMin (Eigen::Vector3i (i, j, k));
          high = high.cwiseMax (Eigen::Vector3i (i + 1, j + 1, k + 1));
        }
  return {Eigen::Vector3d ((edge * low).cast<double> ()),
          Eigen::Vector3d ((edge * high).cast<double> ().cwiseMin (last_voxel_))};
}

} // namespace pcl::cosection
