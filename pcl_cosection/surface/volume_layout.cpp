// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "volume_layout.h"

#include "shape_volume.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double outlier_share = 0.005; // of the points, at either end of each axis
constexpr int default_resolution = 64;
constexpr double points_per_voxel = 3.0;
constexpr double voxel_growth = 1.1;
constexpr int min_axis = 8;      // voxels
constexpr double max_axis = 8192; // voxels
constexpr double min_extent_m = 1e-6;

/** \brief Voxels of edge \a h with a point in them. */
std::size_t
occupiedVoxels (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box, double h)
{
  std::vector<std::uint64_t> keys;
  keys.reserve (points.size ());
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d at = (p.position.cast<double> () - box.min ()) / h;
    if (!box.contains (p.position.cast<double> ()))
      continue;
    keys.push_back ((static_cast<std::uint64_t> (at.z ()) << 42) | (static_cast<std::uint64_t> (at.y ()) << 21) |
                    static_cast<std::uint64_t> (at.x ()));
  }
  std::sort (keys.begin (), keys.end ());
  return static_cast<std::size_t> (std::unique (keys.begin (), keys.end ()) - keys.begin ());
}

double
supportedVoxelSize (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  const double longest = box.sizes ().maxCoeff ();
  double h = longest / default_resolution;
  while (h < longest / min_axis &&
         static_cast<double> (points.size ()) < points_per_voxel * static_cast<double> (occupiedVoxels (points, box, h)))
    h *= voxel_growth;
  return h;
}

std::string
megabytes (std::size_t bytes)
{
  std::ostringstream text;
  text << bytes / (1024 * 1024) << " MiB";
  return text.str ();
}

} // namespace

VoxelGrid
layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m, const CoSectionOptions& options)
{
  VoxelGrid grid;
  grid.voxel_size_m = voxel_size_m;
  const Eigen::Vector3d cells = box.sizes () / voxel_size_m;
  if (!(cells.maxCoeff () < max_axis))
  {
    std::ostringstream message;
    message << "voxel size " << voxel_size_m << " m gives " << cells.maxCoeff () << " voxels along one side; at most "
            << max_axis << " are possible";
    throw InvalidArgument (message.str ());
  }
  for (int a = 0; a < 3; ++a)
    grid.dims[a] = std::max (min_axis, static_cast<int> (std::ceil (cells[a])) + 1);
  grid.origin_m = box.center () - 0.5 * voxel_size_m * (grid.dims.cast<double> () - Eigen::Vector3d::Ones ());
  const std::size_t bytes = ShapeVolume::estimateBytes (grid);
  if (options.max_memory_bytes > 0 && bytes > options.max_memory_bytes)
  {
    std::ostringstream message;
    message << "a volume of " << grid.dims.x () << " x " << grid.dims.y () << " x " << grid.dims.z () << " voxels needs "
            << megabytes (bytes) << "; " << megabytes (options.max_memory_bytes)
            << " are allowed: use larger voxels or allow more memory";
    throw MemoryLimitExceeded (message.str ());
  }
  return grid;
}

VoxelGrid
layoutObject (const std::vector<OrientedPoint>& points, const CoSectionOptions& options)
{
  Eigen::AlignedBox3d box;
  std::vector<float> values (points.size ());
  if (points.empty ())
    throw DegenerateInput ("no points with finite coordinates and a normal");
  for (int a = 0; a < 3; ++a)
  {
    for (std::size_t n = 0; n < points.size (); ++n)
      values[n] = points[n].position[a];
    if (!std::all_of (values.begin (), values.end (), [] (float v) { return std::isfinite (v); }))
      throw DegenerateInput ("some points have no finite coordinates");
    const auto cut = static_cast<std::ptrdiff_t> (outlier_share * static_cast<double> (values.size ()));
    std::nth_element (values.begin (), values.begin () + cut, values.end ());
    box.min ()[a] = values[cut];
    const auto high = static_cast<std::ptrdiff_t> (values.size ()) - 1 - cut;
    std::nth_element (values.begin (), values.begin () + high, values.end ());
    box.max ()[a] = values[high];
  }
  const double longest = box.sizes ().maxCoeff ();
  if (!(longest > min_extent_m))
    throw DegenerateInput ("all points lie on one spot");
  double h = options.voxel_size_m;
  if (h <= 0.0)
    h = options.resolution > 0 ? longest / options.resolution : supportedVoxelSize (points, box);
  else if (h > longest)
  {
    std::ostringstream message;
    message << "voxel size " << h << " m is larger than the object, which is " << longest << " m long";
    throw InvalidArgument (message.str ());
  }
  const Eigen::Vector3d pad = Eigen::Vector3d::Constant (options.padding * longest + 2.0 * h);
  return layoutBox ({box.min () - pad, box.max () + pad}, h, options);
}

Eigen::AlignedBox3d
boxOf (const VoxelGrid& grid)
{
  return {grid.origin_m, grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1)};
}

std::vector<Eigen::AlignedBox3d>
uniteOverlapping (std::vector<Eigen::AlignedBox3d> boxes)
{
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (std::size_t i = 0; i < boxes.size (); ++i)
      for (std::size_t j = boxes.size (); j-- > i + 1;)
        if (boxes[i].intersects (boxes[j]))
        {
          boxes[i].extend (boxes[j]);
          boxes.erase (boxes.begin () + static_cast<std::ptrdiff_t> (j));
          changed = true;
        }
  }
  return boxes;
}

} // namespace cosection
} // namespace pcl
