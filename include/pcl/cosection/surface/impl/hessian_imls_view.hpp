// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

// A member template: every program instantiates it for its own point types.

#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/console/print.h>

#include <limits>

template <typename PointNT>
template <typename PointT> bool
pcl::cosection::HessianIMLS<PointNT>::addView (const pcl::PointCloud<PointT>& cloud, const Eigen::Isometry3d& T_object_sensor)
{
  std::vector<Eigen::Vector3f> points;
  points.reserve (cloud.size ());
  DepthView view;
  view.T_world_sensor = T_object_sensor;
  for (const PointT& p : cloud)
  {
    points.emplace_back (p.x, p.y, p.z);
    view.depth.push_back (p.z > 0.0f ? p.z : std::numeric_limits<float>::quiet_NaN ());
  }
  const auto camera = cloud.height > 1 ? fitPinholeCamera (points, static_cast<int> (cloud.width), static_cast<int> (cloud.height))
                                       : std::nullopt;
  if (!camera)
  {
    PCL_ERROR ("[pcl::%s::addView] The cloud is not the image of a pinhole camera in its sensor's frame; it is left out.\n",
               getClassName ().c_str ());
    return false;
  }
  view.camera = *camera;
  addView (view);
  return true;
}
