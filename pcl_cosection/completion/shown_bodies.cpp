// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "shown_bodies.h"

#include "pcl_cosection/view/visibility/free_space_view.h"
#include "pcl_cosection/view/visibility/free_space_votes.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <cmath>
#include <limits>
#include <optional>

namespace pcl::cosection {

std::vector<int>
bodiesShown (const Scene& scene, std::size_t view)
{
  const DepthView& depth = scene.views[view].depth;
  std::vector<int> bodies (depth.depth.size (), FreeSpaceView::unknown_body);
  std::vector<float> nearest_m (depth.depth.size (), std::numeric_limits<float>::infinity ());
  const auto show = [&] (int body, const OrientedPoint& point, const Eigen::Isometry3d& T_sensor_points) {
    const Eigen::Vector3d p = T_sensor_points * point.position.cast<double> ();
    const std::optional<Eigen::Array2i> at = pixelOf (depth.camera, p);
    if (!at)
      return;
    const std::size_t pixel = static_cast<std::size_t> (at->y ()) * depth.camera.width + at->x ();
    const float reading = depth.depth[pixel];
    const auto distance_m = static_cast<float> (std::abs (reading - p.z ()));
    if (!(distance_m < nearest_m[pixel]) ||
        compareWithReading (p.z (), reading, pointMargin (depth, reading)) != PointVisibility::AtSurface)
      return;
    nearest_m[pixel] = distance_m;
    bodies[pixel] = body;
  };
  const auto showAll = [&] (int body, const std::vector<OrientedPoint>& points, const Eigen::Isometry3d& T_world_body) {
    const auto batches = scene.batches.find (body);
    if (batches == scene.batches.end () || !T_world_body.matrix ().allFinite ())
      return;
    const Eigen::Isometry3d T_sensor_body = depth.T_world_sensor.inverse () * T_world_body;
    std::size_t begin = 0;
    for (const PointBatch& batch : batches->second)
    {
      const std::size_t end = begin + batch.count;
      if (batch.view < 0 || batch.view == static_cast<int> (view))
        for (std::size_t n = begin; n < end; ++n)
          show (body, points[n], T_sensor_body);
      begin = end;
    }
  };
  for (const ObjectInput& object : scene.objects)
    showAll (object.id, object.points, poseAt (object, view));
  showAll (0, scene.background, Eigen::Isometry3d::Identity ());
  return bodies;
}

} // namespace pcl::cosection
