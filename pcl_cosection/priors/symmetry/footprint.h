// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cmath>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Axes of a plane, and the footprint on it of points. Places on it are relative to the footprint's middle, so
 * that an angle and an offset from it are independent. */
class Footprint
{
public:
  /** \param[in] plane unit normal, and offset */
  Footprint (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, const Eigen::Vector4d& plane);

  const Eigen::Vector3d& up () const { return up_; }
  double voxelSize () const { return voxel_size_m_; }
  double step () const { return step_; } ///< of a search over places, metres
  int steps () const { return steps_; }  ///< to either side of the middle
  double bottom () const { return bottom_; }
  double top () const { return top_; }

  /** \brief A place on the plane. */
  Eigen::Vector3d place (double x, double y) const { return origin_ + x * a_ + y * b_; }

  Eigen::Vector3d direction (double angle) const { return std::cos (angle) * a_ + std::sin (angle) * b_; }

  /** \brief The plane across a direction at a distance from the middle: n.x of its points. */
  double across (const Eigen::Vector3d& n, double offset) const { return n.dot (origin_) + offset; }

  /** \brief The angle of walls at right angles to each other, if most normals are those of such walls: the one that
   * maximises the sum of the fourth powers of the normals' components along it and across. */
  std::optional<double> angleOfWalls (const std::vector<OrientedPoint>& points) const;

private:
  double voxel_size_m_;
  Eigen::Vector3d up_, a_, b_, origin_;          // the plane's place below the middle
  double step_ = 0.0, bottom_ = 0.0, top_ = 0.0; // heights over the plane
  int steps_ = 0;
};

} // namespace pcl::cosection
