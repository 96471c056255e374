// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

// A member template: every program instantiates it for its own point types.

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/surface/free_space_filter.h>

#include <pcl/console/print.h>

template <typename PointT>
template <typename PointViewT>
bool
pcl::cosection::FreeSpaceFilter<PointT>::addView (const pcl::PointCloud<PointViewT>& cloud,
                                                  const Eigen::Isometry3d& T_cloud_sensor)
{
  const auto view = toDepthView (cloud, T_cloud_sensor);
  if (view)
    addView (*view);
  else
    PCL_ERROR ("[pcl::%s::addView] The cloud is not the image of a pinhole camera in its sensor's frame; "
               "it is left out.\n",
               getClassName ().c_str ());
  return view.has_value ();
}
