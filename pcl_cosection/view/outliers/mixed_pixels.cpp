// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels.h"

#include "pcl_cosection/view/visibility/visibility.h"

#include "pcl_cosection/view/visibility/free_space_view.h"

#include <limits>

namespace pcl::cosection {

void
leaveOutMixedPixels (const DepthView& view, SensorCloud& cloud)
{
  const FreeSpaceView seen (view);
  const Eigen::Isometry3d T_view_points = view.T_world_sensor.inverse () * cloud.T_world_sensor;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    if (cloud.labels[i] != 0 || !cloud.positions[i].allFinite ())
      continue;
    const std::optional<Eigen::Array2i> pixel = pixelOf (view.camera,
                                                         T_view_points * cloud.positions[i].cast<double> ());
    if (pixel && seen.atEdge (pixel->x (), pixel->y ()))
      cloud.normals[i].setConstant (std::numeric_limits<float>::quiet_NaN ());
  }
}

} // namespace pcl::cosection
