// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <array>

namespace pcl::cosection {

/** \brief A convex polygon in the sensor frame: a triangle after clipping. */
struct ClippedPolygon
{
  static constexpr int max_corners = 8; ///< a triangle cut by five planes

  std::array<Eigen::Vector3d, max_corners> corners;
  int count = 0;
};

/** \brief Cuts triangles at the near plane and, far outside of the picture, at its sides, so that
 * pixel coordinates stay small. Two triangles of one edge are cut in the same points of it. */
class FrustumClip
{
public:
  /** \brief How far outside of the picture coordinates may be, pixels. */
  static constexpr double guard_band_px = 8192.0;

  FrustumClip (const PinholeCamera& camera, double near_m);

  bool contains (const Eigen::Vector3d& p) const;

  ClippedPolygon clip (const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) const;

private:
  static constexpr int plane_count = 5;

  double distance (int plane, const Eigen::Vector3d& p) const { return normals_[plane].dot (p) - offsets_[plane]; }

  std::array<Eigen::Vector3d, plane_count> normals_;
  std::array<double, plane_count> offsets_;
};

} // namespace pcl::cosection
