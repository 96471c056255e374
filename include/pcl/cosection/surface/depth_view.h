// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera_resection.h>
#include <pcl/cosection/surface/range_image.h>

#include <pcl/point_cloud.h>

#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief The depth image that an organised cloud is, or that an unorganised one gives (drawRangeImage ()).
 * \param[in] cloud in its sensor's frame (organised: x right, y down, z forward), metres; not finite, or z <= 0 of an
 * organised one: no reading. An organised one may be in any other frame, as its pixels tell the sensor's pose there
 * (locateCamera ())
 * \param[in] T_world_sensor pose of the sensor, or of the frame in which the points are
 * \return nothing if an organised cloud is not the image of a pinhole camera (fitPinholeCamera ()), or if more than a
 * tenth of the points of an unorganised one is hidden from the sensor */
template <typename PointT>
std::optional<DepthView>
toDepthView (const pcl::PointCloud<PointT>& cloud,
             const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity ())
{
  if (cloud.empty () || (cloud.height > 1 && cloud.size () != static_cast<std::size_t> (cloud.width) * cloud.height))
    return std::nullopt;
  std::vector<Eigen::Vector3f> points;
  points.reserve (cloud.size ());
  for (const PointT& p : cloud)
    points.emplace_back (p.x, p.y, p.z);
  if (cloud.height > 1)
    return organizedDepthView (points, static_cast<int> (cloud.width), static_cast<int> (cloud.height), T_world_sensor);
  std::optional<RangeImage> image = drawRangeImage (points, Eigen::Vector3d::Zero ());
  if (!image || image->hidden_share > RangeImage::max_hidden_share)
    return std::nullopt;
  image->view.T_world_sensor = T_world_sensor * image->view.T_world_sensor;
  return std::move (image->view);
}

} // namespace pcl::cosection
