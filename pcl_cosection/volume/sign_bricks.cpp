// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "sign_bricks.h"

#include "../common/multiversion.h"

#include <pcl/cosection/common/parallel.h>

#include <algorithm>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr std::int32_t positive = 1;
constexpr std::int32_t not_positive = 2;

/** \brief Of the voxels of a row; NaN has no sign. */
PCL_COSECTION_MULTIVERSION void
addSigns (const float* __restrict values, int count, std::int32_t* __restrict signs)
{
  for (int i = 0; i < count; ++i)
    signs[i] |= (values[i] > 0.0f ? positive : 0) | (values[i] <= 0.0f ? not_positive : 0);
}

/** \brief Each byte or that before or behind it by \a stride; \a count of them, in lines of \a length. */
PCL_COSECTION_MULTIVERSION void
dilate (const std::uint8_t* __restrict bytes, std::size_t count, std::size_t length, std::size_t stride,
        std::uint8_t* __restrict dilated)
{
  const std::size_t line = length * stride;
  for (std::size_t begin = 0; begin < count; begin += line)
  {
    const std::uint8_t* from = bytes + begin;
    std::uint8_t* to = dilated + begin;
    std::copy_n (from, line, to);
    for (std::size_t i = stride; i < line; ++i)
      to[i] |= from[i - stride];
    for (std::size_t i = stride; i < line; ++i)
      to[i - stride] |= from[i];
  }
}

} // namespace

SignBricks::SignBricks (const SignedDistanceField& field, int threads)
: dims_ ((field.grid.dims.array () + (edge - 2)) / edge) // cells are one fewer than voxels
, last_voxel_ (field.grid.dims.cast<double> ().array () - 1.0)
{
  measureDistances (findMixed (field, threads));
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
  return {Eigen::Vector3d ((edge * low).cast<double> ()), Eigen::Vector3d ((edge * high).cast<double> ().cwiseMin (last_voxel_))};
}

void
SignBricks::measureDistances (std::vector<std::uint8_t> mixed)
{
  const std::size_t nx = dims_.x ();
  const std::size_t ny = dims_.y ();
  const std::size_t nz = dims_.z ();
  distances_.assign (mixed.size (), 0);
  std::vector<std::uint8_t> other (mixed.size ());
  for (int distance = 0;; ++distance)
  {
    for (std::size_t b = 0; b < mixed.size (); ++b)
      distances_[b] += !mixed[b];
    if (distance + 1 == max_distance)
      return;
    dilate (mixed.data (), mixed.size (), nx, 1, other.data ());
    dilate (other.data (), mixed.size (), ny, nx, mixed.data ());
    dilate (mixed.data (), mixed.size (), nz, nx * ny, other.data ());
    mixed.swap (other);
  }
}

} // namespace cosection
} // namespace pcl
