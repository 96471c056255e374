// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/pcd_cloud.h"

#include <pcl/cosection/io/pcd_view.h>

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

/** \brief An unorganised cloud as seen from its sensor: at the viewpoint of its header, if all points are visible from
 * there, or else where the order of its points says. Points of another frame than the sensor's are moved into it. \a
 * result.warnings says what is not as in the header.
 * \return nothing if that is not known */
std::optional<DepthView> viewFromSensor (const std::string& path, const PcdViewOptions& options, const Members& members,
                                         SensorCloud& cloud, LabelledView& result);

/** \brief Some of all. */
inline std::vector<Eigen::Vector3f>
pick (const std::vector<Eigen::Vector3f>& all, const std::vector<std::size_t>& indices)
{
  std::vector<Eigen::Vector3f> picked;
  picked.reserve (indices.size ());
  for (const std::size_t i : indices)
    picked.push_back (all[i]);
  return picked;
}

/** \brief "12 %" */
std::string percentText (double share);

} // namespace pcl::cosection
