// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_visibility.h"

#include <pcl/cosection/rendering/rasterizer.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double width_px = 160.0; ///< of the pictures that are drawn to find out
constexpr double least_share = 0.001;

PinholeCamera
reduced (const PinholeCamera& camera)
{
  const double factor = std::min (1.0, width_px / camera.width);
  PinholeCamera result;
  result.width = std::max (1, static_cast<int> (camera.width * factor));
  result.height = std::max (1, static_cast<int> (camera.height * factor));
  result.fx = camera.fx * factor;
  result.fy = camera.fy * factor;
  result.cx = (camera.cx + 0.5) * factor - 0.5;
  result.cy = (camera.cy + 0.5) * factor - 0.5;
  return result;
}

} // namespace

std::vector<std::vector<double>>
visibleStamps (const SceneRecord& scene, double max_difference_s)
{
  // By frame of the camera, the index of each object's pose.
  std::vector<std::vector<std::optional<std::size_t>>> poses (scene.objects.size ());
  for (std::size_t n = 0; n < scene.objects.size (); ++n)
  {
    poses[n].resize (scene.camera.size ());
    for (const PosePair& pair : associatePoses (scene.camera, scene.objects[n].poses, max_difference_s))
      poses[n][pair.truth] = pair.estimate;
  }
  std::vector<std::vector<double>> stamps (scene.objects.size ());
  for (std::size_t frame = 0; frame < scene.camera.size (); ++frame)
  {
    std::vector<std::size_t> pixels (scene.objects.size (), 0);
    std::size_t least = 0;
    if (scene.intrinsics)
    {
      const PinholeCamera camera = reduced (*scene.intrinsics);
      Rasterizer rasterizer (camera, scene.camera[frame].pose);
      if (!scene.background.empty ())
        rasterizer.draw (scene.background, static_cast<int> (scene.objects.size ()));
      for (std::size_t n = 0; n < scene.objects.size (); ++n)
        if (poses[n][frame] && !scene.objects[n].mesh.empty ())
          rasterizer.draw (scene.objects[n].mesh, static_cast<int> (n), scene.objects[n].poses[*poses[n][frame]].pose);
      for (const std::int32_t id : rasterizer.image ().ids)
        if (id >= 0 && id < static_cast<std::int32_t> (pixels.size ()))
          ++pixels[static_cast<std::size_t> (id)];
      least = std::max<std::size_t> (1, static_cast<std::size_t> (least_share * camera.width * camera.height));
    }
    for (std::size_t n = 0; n < scene.objects.size (); ++n)
      if (poses[n][frame] && pixels[n] >= least)
        stamps[n].push_back (scene.camera[frame].stamp);
  }
  return stamps;
}

} // namespace pcl::cosection
