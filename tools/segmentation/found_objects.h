// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "segment_command_line.h"

#include "pcl_cosection/view/organized_cloud.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/** \brief The objects in a view. */
struct FoundObjects
{
  struct Object
  {
    std::size_t points = 0;
    std::optional<pcl::cosection::DetectedInstance> detected; ///< by a network
  };

  std::vector<std::uint32_t> labels; ///< one per point
  std::vector<Object> objects;       ///< label n is at n - 1
  std::vector<Eigen::Vector4f> support_planes;
};

/** \brief Find them as the user asked for. \param[in] detector null: by geometry
 * \throws UsageError, pcl::cosection::Error naming the file */
FoundObjects findObjects (const SegmentSettings& settings, const pcl::cosection::OrganizedCloud& cloud,
                          pcl::cosection::InstanceDetector* detector);
