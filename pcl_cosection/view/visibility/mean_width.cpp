// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mean_width.h"

#include "visibility.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace pcl::cosection {

double
meanWidth (const SensorViews& views, const std::vector<OrientedPoint>& points)
{
  constexpr std::array<std::array<int, 2>, 4> neighbours = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  double area_m2 = 0.0, outline_m = 0.0;
  for (const auto& [view, T_object_sensor] : views)
  {
    const PinholeCamera& camera = view->camera;
    const Eigen::Isometry3d T_sensor_object = T_object_sensor.inverse ();
    std::vector<std::uint8_t> is_object (static_cast<std::size_t> (camera.width) * camera.height, 0);
    std::vector<Eigen::Array2i> pixels;
    for (const OrientedPoint& point : points)
      if (const auto pixel = pixelOf (camera, T_sensor_object * point.position.cast<double> ()))
        if (std::uint8_t& here = is_object[static_cast<std::size_t> (pixel->y ()) * camera.width + pixel->x ()];
            here == 0 && isReading (view->at (pixel->x (), pixel->y ())))
        {
          here = 1;
          pixels.push_back (*pixel);
        }
    for (const Eigen::Array2i& pixel : pixels)
    {
      const double depth_m = view->at (pixel.x (), pixel.y ());
      area_m2 += depth_m * depth_m / (camera.fx * camera.fy);
      for (const auto& [across, down] : neighbours)
      {
        const int u = pixel.x () + across, v = pixel.y () + down;
        const bool is_inside = u >= 0 && v >= 0 && u < camera.width && v < camera.height;
        // Readings that are missing are no outline.
        if (!is_inside ||
            (is_object[static_cast<std::size_t> (v) * camera.width + u] == 0 && isReading (view->at (u, v))))
          outline_m += depth_m / (across != 0 ? camera.fy : camera.fx);
      }
    }
  }
  return outline_m > 0.0 ? 2.0 * area_m2 / outline_m : 0.0;
}

} // namespace pcl::cosection
