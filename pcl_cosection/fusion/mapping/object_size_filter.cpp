// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_size_filter.h"

#include "pcl_cosection/common/cell_key.h"

#include <cstddef>

namespace pcl::cosection {
namespace {

constexpr double voxel_m = 0.05; // poses are known better

} // namespace

void
ObjectSizeFilter::filter (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_camera,
                          ObjectSegmentation& found)
{
  ++frame_;
  std::vector<std::size_t> pixels (found.objects + 1, 0), too_long (found.objects + 1, 0);
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const std::uint32_t label = found.labels[n];
    if (label == 0 && !found.too_long[n])
      continue;
    const Eigen::Array3d place = (T_world_camera * points[n].cast<double> ()).array () / voxel_m;
    const CellIndex voxel = place.round ().cast<std::int64_t> ();
    Frames& frames = counts_[keyOf (voxel)];
    if (frames.counted != frame_)
      ++(label == 0 ? frames.too_long : frames.object);
    frames.counted = frame_;
    ++pixels[label];
    too_long[label] += frames.too_long > frames.object;
  }
  for (std::uint32_t& label : found.labels)
    if (label != 0 && 2 * too_long[label] > pixels[label])
      label = 0;
}

} // namespace pcl::cosection
