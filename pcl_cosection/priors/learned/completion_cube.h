// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The cube of voxels in which a network completes an object. It stands on the support plane, two voxels of it
 * below; x points away from the sensors, z up. What was seen fills a third to two thirds of it. */
struct PCL_COSECTION_EXPORT CompletionCube
{
  static constexpr int size = 32;               ///< voxels along an edge
  static constexpr int below_vox = 2;           ///< layers below the plane
  static constexpr double truncation_vox = 3.0; ///< of distances
  static constexpr std::size_t voxels = static_cast<std::size_t> (size) * size * size;
  Eigen::Isometry3d T_object_cube = Eigen::Isometry3d::Identity (); ///< metres; the origin is a corner
  double voxel_size_m = 0.0;

  /** \brief x is fastest. */
  static std::size_t index (int i, int j, int k) { return (static_cast<std::size_t> (k) * size + j) * size + i; }

  Eigen::Vector3d center (int i, int j, int k) const
  {
    return T_object_cube * (voxel_size_m * (Eigen::Vector3d (i, j, k) + Eigen::Vector3d::Constant (0.5)));
  }
};

/** \brief The cube for an object; nothing if the points have no extent, or no view sees them.
 * \param[in] points of the object, its frame, metres
 * \param[in] views of it, and the sensors' poses in its frame
 * \param[in] plane n.x + d = 0 on which it stands, unit n towards it */
PCL_COSECTION_EXPORT std::optional<CompletionCube>
completionCube (const std::vector<OrientedPoint>& points, const SensorViews& views, const Eigen::Vector4d& plane);

/** \brief What the views say of a voxel. */
struct CompletionInputs
{
  std::vector<float>
      distance; ///< from the object's own readings, along their rays, truncated to +-3 voxels, which is +-1
  std::vector<std::uint8_t> is_free;    ///< a view looks through it
  std::vector<std::uint8_t> is_behind;  ///< the object's own surface hides it
  std::vector<std::uint8_t> is_unknown; ///< no view tells anything
};

/** \brief What the views say of the voxels of a cube; below the plane all is zero. Parameters as completionCube (). */
PCL_COSECTION_EXPORT CompletionInputs completionInputs (const CompletionCube& cube,
                                                        const std::vector<OrientedPoint>& points,
                                                        const SensorViews& views);

} // namespace pcl::cosection
