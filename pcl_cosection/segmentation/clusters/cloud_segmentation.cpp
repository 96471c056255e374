// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_segmentation.h"

#include "cluster_segmentation.h"

namespace pcl::cosection {

ObjectSegmentation
segmentCloud (const OrganizedCloud& cloud, const ObjectSegmentationOptions& options)
{
  return cloud.height > 1 ? segmentObjects (cloud.points, cloud.width, cloud.height, options)
                          : segmentClusters (cloud.points, options);
}

} // namespace pcl::cosection
