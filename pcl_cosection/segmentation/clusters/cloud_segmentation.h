// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/organized_cloud.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Find the objects in a cloud: by segmentObjects () in an organised one and in one whose sensor saw dense
 * surfaces from the origin, else by segmentClusters ().
 * \throws DegenerateInput, InvalidArgument as these */
ObjectSegmentation segmentCloud (const OrganizedCloud& cloud, const ObjectSegmentationOptions& options);

/** \brief What a user should know of the objects that were found in a cloud, one line each: no plane, things that are
 * too long. */
std::vector<std::string> warningsOf (const ObjectSegmentation& found, const ObjectSegmentationOptions& options);

} // namespace pcl::cosection
