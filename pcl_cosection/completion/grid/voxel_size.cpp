// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "voxel_size.h"

#include "pcl_cosection/common/cell_key.h"
#include "pcl_cosection/common/quantile.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr int default_resolution = 64;
constexpr double points_per_voxel = 3.0;
// So few points per voxel are enough if more would need voxels so large that they lose the shape:
constexpr double least_points_per_voxel = 1.5;
constexpr int least_resolution = 16; // voxels along the longest side
constexpr double voxel_growth = 1.1;
// Voxels smaller than the points' spacing supports, by this factor, are more accurate than coarse ones with less
// smoothing, and than fine ones with the absolute smoothing of coarse ones.
constexpr double finer = 0.65;
// But voxels must not be finer than this multiple of the points' noise, which voxels of three points average.
constexpr double voxels_per_noise = 1.6;
constexpr std::size_t points_to_measure_noise = 5; // in a cell
constexpr double noise_cells = 3.0;  // their edge, in supported voxels: smaller cells would clip the noise
constexpr double facing_alike = 0.4; // least length of the mean normal: a cell with less holds two sides of a wall
constexpr double voxels_per_wall = 2.0;
constexpr double finest_vessel = 0.5; // of the voxels that the points' spacing supports
constexpr int least_voxels = 8;       // voxels

/** \brief Voxels of edge \a h with a point in them. */
std::size_t
occupiedVoxels (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box, double h)
{
  const Eigen::Array3i dims = (box.sizes () / h).array ().floor ().cast<int> () + 1;
  std::vector<std::uint8_t> occupied (static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (), 0);
  std::size_t count = 0;
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d position = p.position.cast<double> ();
    if (!box.contains (position))
      continue;
    const Eigen::Array3i at = ((position - box.min ()) / h).cast<int> ();
    std::uint8_t& voxel = occupied[(static_cast<std::size_t> (at.z ()) * dims.y () + at.y ()) * dims.x () + at.x ()];
    count += voxel == 0;
    voxel = 1;
  }
  return count;
}

/** \brief Sums of the points in a cell. */
struct CellOfPoints
{
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero ();
  Eigen::Vector3d place = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero ();

  void add (const Eigen::Vector3d& p, const Eigen::Vector3d& n)
  {
    ++count;
    normal += n;
    place += p;
    squares += p * p.transpose ();
  }

  /** \brief Standard deviation from the plane through their mean with their mean normal. */
  double scatterAlongNormal () const
  {
    const Eigen::Vector3d n = normal.normalized ();
    const double mean = n.dot (place) / static_cast<double> (count);
    const double sum = n.dot (squares * n) - static_cast<double> (count) * mean * mean;
    return std::sqrt (std::max (0.0, sum) / static_cast<double> (count - 1));
  }
};

double
accurateVoxelSize (const PointSpacing& spacing, double longest_m)
{
  const double noise_m = std::min (spacing.supported_m, voxels_per_noise * spacing.noise_m);
  return std::max ({finer * spacing.supported_m, noise_m, longest_m / default_resolution});
}

} // namespace

double
supportedVoxelSize (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  const double longest = box.sizes ().maxCoeff ();
  double h = longest / default_resolution;
  const auto supported = [&] {
    const double wanted = h < longest / least_resolution ? points_per_voxel : least_points_per_voxel;
    return static_cast<double> (points.size ()) >= wanted * static_cast<double> (occupiedVoxels (points, box, h));
  };
  while (h < longest / least_voxels && !supported ())
    h *= voxel_growth;
  return h;
}

PointSpacing
measureSpacing (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  PointSpacing spacing;
  spacing.supported_m = supportedVoxelSize (points, box);
  if (!(spacing.supported_m > box.sizes ().maxCoeff () / default_resolution)) // the finest size
    return spacing;
  std::unordered_map<std::uint64_t, CellOfPoints> cells;
  const double per_m = 1.0 / (noise_cells * spacing.supported_m);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d place = point.position.cast<double> () - box.min ();
    if (const auto cell = cellOf (per_m * place))
      cells[keyOf (*cell)].add (place, point.normal.cast<double> ());
  }
  std::vector<double> noise_m;
  for (const auto& [key, cell] : cells)
    if (cell.count >= points_to_measure_noise && cell.normal.norm () > facing_alike * static_cast<double> (cell.count))
      noise_m.push_back (cell.scatterAlongNormal ());
  if (!noise_m.empty ())
    spacing.noise_m = upperMedian (noise_m);
  return spacing;
}

bool
fixedVoxelSize (const CoSectionOptions& options)
{
  return options.voxel_size_m > 0.0 || options.resolution > 0;
}

double
objectVoxelSize (const PointSpacing& spacing, const Eigen::AlignedBox3d& box, const CoSectionOptions& options)
{
  const double longest = box.sizes ().maxCoeff ();
  const double h = options.voxel_size_m;
  if (h <= 0.0)
    return options.resolution > 0 ? longest / options.resolution : accurateVoxelSize (spacing, longest);
  if (h > longest)
  {
    std::ostringstream message;
    message << "voxel size " << h << " m is larger than the object, which is " << longest << " m long";
    throw InvalidArgument (message.str ());
  }
  return h;
}

double
vesselVoxelSize (double supported_m, double wall_m, const Eigen::AlignedBox3d& box)
{
  const double least_m = std::max (finest_vessel * supported_m, box.sizes ().maxCoeff () / default_resolution);
  return std::min (supported_m, std::max (least_m, wall_m / voxels_per_wall));
}

} // namespace pcl::cosection
