// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_file.h"

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Of coordinates that no reading gave, and of normals that are not known. */
inline constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();

/** \brief The points of a file, in the sensor frame. */
struct SensorCloud
{
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> positions; ///< NaN: no reading
  std::vector<Eigen::Vector3f> normals;   ///< empty if the file has none
  std::vector<std::uint32_t> labels;
  std::vector<std::array<std::uint8_t, 3>> colours;                  ///< empty if the file has none
  std::vector<float> intensities;                                    ///< empty if the file has none
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity (); ///< relative to the origin
  Eigen::Vector3d origin = Eigen::Vector3d::Zero ();                 ///< in the world frame of the file, metres
  bool has_viewpoint = false;                                        ///< the file's is not the default one
  bool in_world = false; ///< the file's points are in the world frame, not in the sensor's
  Eigen::Isometry3d T_points_sensor = Eigen::Isometry3d::Identity (); ///< else: the sensor's axes in the file's
  double working_range_m = 1.0;                                       ///< of the sensor; see DepthView
  bool has_labels = false;
  std::size_t ignored = 0;           ///< points of a negative label, or of ignored_label
  std::vector<std::string> warnings; ///< of the fields, one line each
};

/** \brief Read the points of a PCD or PLY file; see readPcdView () for the fields and the errors. \param[in]
 * with_labels else they are not looked at */
SensorCloud readSensorCloud (const std::string& path, const PcdViewOptions& options, bool with_labels = true);

/** \brief Refuse points that need more memory than is allowed: as they are given, and as they are returned.
 * \throws MemoryLimitExceeded */
void checkMemory (const std::string& path, const CloudHeader& header, std::size_t limit_bytes);

/** \brief The points of a file that were read, in the sensor frame. \param[in] path for messages \param[in] header
 * describes \a cloud */
SensorCloud toSensorCloud (const std::string& path, const CloudHeader& header, const PCLPointCloud2& cloud,
                           const PcdViewOptions& options, bool with_labels = true);

} // namespace pcl::cosection
