// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/sensor_cloud.h"

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Indices of points by label. */
using Members = std::map<std::uint32_t, std::vector<std::size_t>>;

/** \brief The points of each label that have a finite position. */
Members membersOf (const SensorCloud& cloud);

/** \brief The working range of the sensor follows from the distances of the objects; of all points if there is no
 * object (workingRange ()). \param[in,out] cloud in the frame of its sensor \param[in,out] result its views get the
 * range, too */
void setWorkingRange (const Members& members, SensorCloud& cloud, LabelledView& result);

/** \brief Some of all. */
std::vector<Eigen::Vector3f> pick (const std::vector<Eigen::Vector3f>& all, const std::vector<std::size_t>& indices);

/** \brief A box about each object, by label, that has what is near it. */
using Surroundings = std::map<std::uint32_t, Eigen::AlignedBox3f>;

Surroundings surroundingsOf (const Members& members, const SensorCloud& cloud);

/** \brief The background near objects, and the rest, which may be of a scale that says nothing about what is near. */
struct BackgroundParts
{
  std::vector<std::size_t> near, far;
};

BackgroundParts partsOfBackground (const Surroundings& objects, const Members& members, const SensorCloud& cloud);

/** \brief An unorganised cloud as seen from its sensor: at the viewpoint of its header, if all points are visible from
 * there, or else where the order of its points says. Points of another frame than the sensor's are moved into it. \a
 * result.warnings says what is not as in the header.
 * \a result has no view if that is not known */
void viewFromSensor (const std::string& path, const PcdViewOptions& options, const Members& members, SensorCloud& cloud,
                     LabelledView& result);

/** \brief An organised cloud as seen from the origin by a sensor that scans by angles, maybe all around, as a spinning
 * lidar. \return whether it was: nothing is hidden from there, and the directions of neighbours differ steadily */
bool lookAround (const Members& members, const SensorCloud& cloud, LabelledView& result);

/** \brief Give an organised cloud rays and normals, those of the file if any are not used.
 *
 * The camera is fitted to the points; if they are in another frame than the sensor's, so is its pose, and the points
 * are taken to the sensor. Labels of which too little has a reliable normal (computeOrganizedNormals ()), as with many
 * missing readings, get those of points without an order. \a result.warnings says what is not as in the header. */
void completeOrganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud,
                        LabelledView& result);

/** \brief Give an unorganised cloud normals and, if the points show that the sensor stood at the viewpoint, rays.
 *
 * The viewpoint counts if all points are visible from there, and one that the file leaves at its default only if the
 * points also lie before it as before a camera. Missing normals are estimated, and turned towards the viewpoint, or
 * else consistently and outward. Given normals that the viewpoint or the shape contradict are turned. \a
 * result.warnings says what was turned, if it is more than a few. */
void completeUnorganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud,
                          LabelledView& result);

/** \brief "12 %" */
std::string percentText (double share);

} // namespace pcl::cosection
