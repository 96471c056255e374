// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

// A member template: every program instantiates it for its own point types.

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/console/print.h>

template <typename PointNT>
template <typename PointT>
bool
pcl::cosection::HessianIMLS<PointNT>::addView (const pcl::PointCloud<PointT>& cloud,
                                               const Eigen::Isometry3d& T_object_sensor)
{
  const auto view = toDepthView (cloud, T_object_sensor);
  if (view)
    addView (*view);
  else
    PCL_ERROR ("[pcl::%s::addView] The cloud is not the image of a pinhole camera, nor all visible from the "
               "origin of its frame; it is left out.\n",
               getClassName ().c_str ());
  return view.has_value ();
}
