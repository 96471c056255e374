// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "brick_distances.h"

#include "pcl_cosection/common/multiversion.h"
#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int max_inside_distance = 16; // bricks

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

std::vector<std::uint8_t>
brickDistances (std::vector<std::uint8_t> marked, const Eigen::Vector3i& dims, int max_distance)
{
  const std::size_t nx = dims.x ();
  const std::size_t ny = dims.y ();
  const std::size_t nz = dims.z ();
  std::vector<std::uint8_t> distances (marked.size ());
  std::vector<std::uint8_t> other (marked.size ());
  for (int distance = 0;; ++distance)
  {
    for (std::size_t b = 0; b < marked.size (); ++b)
      distances[b] += !marked[b];
    if (distance + 1 == max_distance)
      return distances;
    dilate (marked.data (), marked.size (), nx, 1, other.data ());
    dilate (other.data (), marked.size (), ny, nx, marked.data ());
    dilate (marked.data (), marked.size (), nz, nx * ny, other.data ());
    marked.swap (other);
  }
}

InsideBricks::InsideBricks (const SignedDistanceField& field, int threads)
    : dims_ ((field.grid.dims.array () + (edge - 1)) / edge)
    , last_voxel_ (field.grid.dims.cast<double> ().array () - 1.0)
{
  const VoxelGrid& grid = field.grid;
  std::vector<std::uint8_t> inside (static_cast<std::size_t> (dims_.x ()) * dims_.y () * dims_.z (), 0);
  parallelFor (0, dims_.z (), threadsForVoxels (threads, grid.size ()), [&] (int bk) {
    for (int k = bk * edge; k < std::min ((bk + 1) * edge, grid.dims.z ()); ++k)
      for (int j = 0; j < grid.dims.y (); ++j)
      {
        std::uint8_t* row = &inside[(static_cast<std::size_t> (bk) * dims_.y () + j / edge) * dims_.x ()];
        const std::size_t first = grid.index (0, j, k);
        for (int i = 0; i < grid.dims.x (); ++i)
          row[i / edge] |= field.mayBeInside (first + i);
      }
  });
  any_ = std::find (inside.begin (), inside.end (), 1) != inside.end ();
  distances_ = brickDistances (std::move (inside), dims_, max_inside_distance);
}

} // namespace pcl::cosection
