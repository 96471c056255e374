// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "footprint.h"

#include "pcl_cosection/priors/shape/axes.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double cells_across = 24.0; // steps along the longer side of the footprint ...
constexpr double reach = 0.75;        // ... and so far to either side of its middle, of that side
constexpr double mostly = 0.5;        // of the normals are those of walls at right angles

} // namespace

Footprint::Footprint (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, const Eigen::Vector4d& plane)
    : voxel_size_m_ (grid.voxel_size_m)
    , up_ (plane.head<3> ())
{
  const Eigen::Matrix3d axes = orientedAxes (points, up_);
  a_ = axes.col (0);
  b_ = axes.col (1);
  Eigen::AlignedBox3d box;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    box.extend (Eigen::Vector3d (a_.dot (p), b_.dot (p), up_.dot (p) + plane[3]));
  }
  bottom_ = box.min ().z ();
  top_ = box.max ().z ();
  origin_ = box.center ().x () * a_ + box.center ().y () * b_ - plane[3] * up_;
  const double side = box.sizes ().head<2> ().maxCoeff ();
  step_ = std::max (side / cells_across, 0.5 * grid.voxel_size_m);
  steps_ = static_cast<int> (std::ceil (reach * side / step_));
}

std::optional<double>
Footprint::angleOfWalls (const std::vector<OrientedPoint>& points) const
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero ();
  double weight = 0.0;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d n = point.normal.cast<double> ();
    const double x = a_.dot (n), y = b_.dot (n);
    const double fourth_power = (x * x + y * y) * (x * x + y * y);
    sum += fourth_power * Eigen::Vector2d (std::cos (4.0 * std::atan2 (y, x)), std::sin (4.0 * std::atan2 (y, x)));
    weight += fourth_power;
  }
  return sum.norm () > mostly * weight ? std::optional<double> (0.25 * std::atan2 (sum.y (), sum.x ())) : std::nullopt;
}

} // namespace pcl::cosection
