// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/keyframe.h>

#include "pcl_cosection/fusion/camera_size.h"

#include <pcl/cosection/surface/normals.h>

#include <limits>

namespace pcl::cosection {

void
KeyframeOptions::validate () const
{
  if (!(max_depth_m > 0.0))
    throw InvalidArgument ("max_depth_m must be positive");
  if (background_step < 1)
    throw InvalidArgument ("background_step must be at least 1");
}

DepthView
makeDepthView (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
               const KeyframeOptions& options)
{
  options.validate ();
  requireSizeOf (camera, depth, "the depth image");
  DepthView view;
  view.camera = camera;
  view.T_world_sensor = T_world_camera;
  view.depth = depth.pixels;
  for (float& z : view.depth)
    if (!(z > 0.0f) || static_cast<double> (z) > options.max_depth_m)
      z = std::numeric_limits<float>::quiet_NaN ();
  return view;
}

Keyframe
makeKeyframe (const RgbdFrame& frame, const PinholeCamera& camera, const Image<std::uint16_t>& instances,
              const Eigen::Isometry3d& T_world_camera, const KeyframeOptions& options)
{
  if (!instances.pixels.empty ())
    requireSizeOf (camera, instances, "the mask");
  Keyframe keyframe;
  keyframe.stamp = frame.stamp;
  keyframe.view = makeDepthView (frame.depth, camera, T_world_camera, options);

  std::vector<Eigen::Vector3f> points;
  points.reserve (keyframe.view.depth.size ());
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      points.push_back (camera.unproject (u, v, keyframe.view.at (u, v)).cast<float> ());
  const std::vector<std::uint32_t> labels (instances.pixels.begin (), instances.pixels.end ());
  OrganizedNormalsOptions normal_options;
  normal_options.threads = options.threads;
  const std::vector<Eigen::Vector3f> normals = computeOrganizedNormals (points, camera.width, camera.height, labels,
                                                                        normal_options);

  const bool coloured = frame.colour.pixels.size () == points.size ();
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * camera.width + u;
      const int instance = labels.empty () ? 0 : static_cast<int> (labels[n]);
      if (!normals[n].allFinite () ||
          (instance == 0 && (u % options.background_step != 0 || v % options.background_step != 0)))
        continue;
      OrientedPoint point;
      point.position = points[n];
      point.normal = normals[n];
      if (coloured)
        point.colour = frame.colour.pixels[n];
      keyframe.points[instance].push_back (point);
    }
  return keyframe;
}

} // namespace pcl::cosection
