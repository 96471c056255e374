// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/view/camera_resection.h"
#include "pcl_cosection/view/range_image.h"
#include <pcl/cosection/common/camera.h>

#include <utility>

namespace pcl::cosection {

std::optional<DepthView>
toDepthView (const std::vector<Eigen::Vector3f>& points, int width, int height, const Eigen::Isometry3d& T_world_points)
{
  if (points.empty ())
    return std::nullopt;
  if (height > 1)
    return organizedDepthView (points, width, height, T_world_points);
  std::optional<RangeImage> image = drawRangeImage (points, Eigen::Vector3d::Zero ());
  if (!image || image->hidden_share > RangeImage::max_hidden_share)
    return std::nullopt;
  image->view.T_world_sensor = T_world_points * image->view.T_world_sensor;
  return std::move (image->view);
}

} // namespace pcl::cosection
