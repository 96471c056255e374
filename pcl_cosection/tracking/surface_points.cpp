// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_points.h"

#include "pcl_cosection/common/multiversion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl::cosection {
namespace {

/** \brief Whether the sign changes from a voxel to the next of its row (1), of the next row (2) and of the next slice
 * (4). */
PCL_COSECTION_MULTIVERSION void
compareSigns (const float* __restrict row, const float* __restrict next_row, const float* __restrict next_slice,
              int count, std::uint8_t* __restrict changes)
{
  for (int i = 0; i < count; ++i)
  {
    const bool negative = row[i] < 0.0f;
    changes[i] = static_cast<std::uint8_t> ((negative != (row[i + 1] < 0.0f) ? 1 : 0) |
                                            (negative != (next_row[i] < 0.0f) ? 2 : 0) |
                                            (negative != (next_slice[i] < 0.0f) ? 4 : 0));
  }
}

} // namespace

std::vector<Eigen::Vector3f>
surfacePoints (const SignedDistanceField& field)
{
  const VoxelGrid& grid = field.grid;
  const std::size_t to_next[] = {1, static_cast<std::size_t> (grid.dims.x ()),
                                 static_cast<std::size_t> (grid.dims.x ()) * grid.dims.y ()};
  const auto known = [&field] (std::size_t v) {
    return std::isfinite (field.values[v]) && (field.supported.empty () || field.supported[v]);
  };
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint8_t> changes (grid.dims.x ());
  std::vector<float> padded (grid.dims.x () + 1); // the row, with its last voxel repeated
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const std::size_t first = grid.index (0, j, k);
      const float* row = field.values.data () + first;
      std::copy_n (row, grid.dims.x (), padded.begin ());
      padded.back () = row[grid.dims.x () - 1];
      compareSigns (padded.data (), j + 1 < grid.dims.y () ? row + to_next[1] : row,
                    k + 1 < grid.dims.z () ? row + to_next[2] : row, grid.dims.x (), changes.data ());
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        if (changes[i] == 0 || !known (first + i)) // most voxels
          continue;
        for (int axis = 0; axis < 3; ++axis)
        {
          const std::size_t end = first + i + to_next[axis];
          if ((changes[i] >> axis & 1) == 0 || !known (end))
            continue;
          const float a = row[i];
          const float b = field.values[end];
          Eigen::Vector3d p = grid.center (i, j, k);
          p[axis] += grid.voxel_size_m * (a / (a - b));
          points.push_back (p.cast<float> ());
        }
      }
    }
  return points;
}

} // namespace pcl::cosection
