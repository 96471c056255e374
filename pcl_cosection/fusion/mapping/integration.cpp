// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "integration.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int mask_border_px = 2; // beside an object, pixels are mixed with its own

} // namespace

void
countAbsorbed (const PosedFrame& frame, const LabelImage& labels, const LabelMap& whole_of, ObjectMap& objects)
{
  for (auto& [id, object] : objects.by_id)
  {
    const auto label = static_cast<std::uint16_t> (id);
    if (std::any_of (whole_of.begin (), whole_of.end (), [label] (const auto& part) { return part.second == label; }))
      object.volume->countForeground (frame.cloud.reliable, frame.cloud.camera,
                                      object.T_world_object.inverse () * frame.T_world_camera, labels, label);
  }
}

void
integrateFrame (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels, bool masked,
                TsdfVolume& background, ObjectMap& objects)
{
  const Image<float>& depth = frame.cloud.reliable;
  const PinholeCamera& camera = frame.cloud.camera;
  TsdfPixels pixels;
  pixels.labels = &labels;
  background.integrate (depth, camera, frame.T_world_camera, pixels);
  if (masked && background.options ().foreground)
    background.countForeground (depth, camera, frame.T_world_camera, labels, 0);
  if (objects.by_id.empty ())
    return;
  const LabelImage wide = widened (labels, mask_border_px);
  if (images.colour.pixels.size () == labels.pixels.size ())
    pixels.colours = &images.colour;
  for (auto& [id, object] : objects.by_id)
  {
    if (!object.isTracked ())
      continue;
    pixels.label = static_cast<std::uint16_t> (id);
    const Eigen::Isometry3d T_object_camera = object.T_world_object.inverse () * frame.T_world_camera;
    object.volume->integrate (depth, camera, T_object_camera, pixels);
    object.volume->integrateFreeSpace (depth, camera, T_object_camera, wide, pixels.label);
    if (masked)
      object.volume->countForeground (depth, camera, T_object_camera, labels, pixels.label);
  }
}

} // namespace pcl::cosection
