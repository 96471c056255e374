// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "mixed_pixels.h"

#include "pcl_cosection/energy/constraints/hull_constraint.h"

#include <limits>

namespace pcl::cosection
{

void
leaveOutFlyingPixels (const DepthView& view, SensorCloud& cloud)
{
  const FreeSpaceView seen (view);
  const Eigen::Isometry3d T_view_points = view.T_world_sensor.inverse () * cloud.T_world_sensor;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    if (cloud.labels[i] != 0 || !cloud.positions[i].allFinite ())
      continue;
    const Eigen::Vector2d pixel = view.camera.project (T_view_points * cloud.positions[i].cast<double> ());
    const Eigen::Vector2i at = (pixel.array () + 0.5).floor ().cast<int> ();
    if (at.x () >= 0 && at.x () < view.camera.width && at.y () >= 0 && at.y () < view.camera.height &&
        seen.atEdge (at.x (), at.y ()))
      cloud.normals[i].setConstant (std::numeric_limits<float>::quiet_NaN ());
  }
}

} // namespace pcl::cosection
