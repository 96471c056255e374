// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "scene_panels.h"

#include <pcl/cosection/visualization/scene_picture.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

namespace
{

constexpr int width_px = 720, height_px = 430;

} // namespace

std::vector<CaptionedPicture>
drawScenePanels (const ReportContent& content)
{
  const RunScene& scene = content.scene;
  const std::vector<double> stamps = scene.stamps ();
  const bool has_objects = std::any_of (scene.run.objects.begin (), scene.run.objects.end (),
                                        [] (const SceneRecord::Object& object) { return (!object.mesh.empty ()); });
  if (stamps.empty () || !has_objects)
    return {};
  SceneView view;
  view.width = width_px;
  view.height = height_px;
  view.legend = view.caption = view.path = view.frustum = false;
  std::vector<CaptionedPicture> pictures;
  const auto add = [&] (double turn_rad, SurfaceMode surface, ColourMode colour, const std::string& caption) {
    view.viewpoint = overview (scene, turn_rad);
    view.surface = surface;
    view.colour = colour;
    pictures.push_back ({caption, "The scene: " + caption, width_px, height_px,
                         dataUri (drawScene (scene, stamps[stamps.size () / 2], view))});
  };
  add (0.0, SurfaceMode::Tsdf, ColourMode::Real, "Seen, from the side of the camera");
  add (0.0, SurfaceMode::Completed, ColourMode::Real, "Completed, from the side of the camera");
  add (M_PI, SurfaceMode::Tsdf, ColourMode::Real, "Seen, from behind");
  add (M_PI, SurfaceMode::Completed, ColourMode::Provenance, "Completed, from behind, by provenance");
  return (pictures);
}
