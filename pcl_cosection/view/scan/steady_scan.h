// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/sensor_cloud.h"

#include <pcl/cosection/common/camera.h>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Usual steps between the directions of neighbours of a sensor that scans by angles, as a spinning lidar:
 * chords of the unit sphere. */
struct ScanSteps
{
  float along_rows = 0.0f;
  float along_columns = 0.0f;
};

/** \brief The steps of an organised cloud as seen from the origin. Nothing if the directions of neighbours do not
 * differ steadily, or if its columns do not cross its rows, as with a width that is not the sensor's. */
std::optional<ScanSteps> stepsOfScan (const SensorCloud& cloud);

/** \brief Depth images of what a scan saw: for each face of a cube about the sensor that has at least 50 points, the
 * one with the most first. Their pixels are as fine as the readings are in the middle of a face. Each shows the reading
 * whose direction is next to its own, so that outlines are half way between readings of two things; none where the next
 * one is farther than half of the diagonal between neighbours.
 * \param[in] cloud in the frame of the sensor, which is also the frame of the images' poses. O (points + pixels) */
std::vector<DepthView> imagesOfScan (const SensorCloud& cloud, const ScanSteps& steps);

} // namespace pcl::cosection
