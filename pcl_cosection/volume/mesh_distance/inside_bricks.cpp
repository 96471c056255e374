// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "inside_bricks.h"

#include "brick_distances.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int max_distance = 16; // bricks

} // namespace

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
  distances_ = brickDistances (std::move (inside), dims_, max_distance);
}

} // namespace pcl::cosection
