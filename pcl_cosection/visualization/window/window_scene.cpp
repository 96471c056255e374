// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "window_scene.h"

#include "vtk_shapes.h"

#include "pcl_cosection/visualization/scene_colours.h"
#include <pcl/cosection/common/error.h>

#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double ambient_light = 0.35; ///< the rest comes from the head light, as in drawScene ()
constexpr double seen_through = 0.25;  ///< opacity of the object that is cut
constexpr float line_px = 2.0f;
constexpr float point_px = 2.0f;

} // namespace

void
WindowScene::setScene (const RunScene& scene)
{
  for (const auto& [key, surface] : surfaces_)
    renderer_.RemoveActor (surface.actor);
  surfaces_.clear ();
  sdf_.reset ();
  shown_points_.reset ();
  scene_ = &scene;
}

vtkActor*
WindowScene::surface (int id, SurfaceMode mode, ColourMode colour)
{
  const TriangleMesh& mesh = scene_->surface (id, mode);
  if (mesh.empty ())
    return nullptr;
  Surface& surface = surfaces_[{id, mode}];
  const bool is_new = !surface.actor;
  if (is_new)
  {
    surface.actor = makeActor (toPolyData (mesh));
    vtkProperty* property = surface.actor->GetProperty ();
    property->SetAmbient (ambient_light);
    property->SetDiffuse (1.0 - ambient_light);
    property->SetBackfaceCulling (id == RunScene::background);
    renderer_.AddActor (surface.actor);
  }
  if (is_new || surface.colour != colour)
  {
    auto* data = vtkPolyDataMapper::SafeDownCast (surface.actor->GetMapper ())->GetInput ();
    data->GetPointData ()->SetScalars (toColours (surfaceColours (*scene_, id, mode, colour)));
    data->Modified ();
    surface.colour = colour;
  }
  return surface.actor;
}

void
WindowScene::showLines (double stamp, const SceneView& view)
{
  std::vector<SceneLine> lines;
  const auto add = [&lines] (const std::vector<SceneLine>& more) {
    lines.insert (lines.end (), more.begin (), more.end ());
  };
  const std::optional<Eigen::Isometry3d> camera = scene_->cameraAt (stamp);
  if (view.path && view.viewpoint)
    add (pathLines (*scene_, stamp));
  if (view.frustum && view.viewpoint && camera)
    add (frustumLines (*scene_, *camera));
  if (view.boxes)
    for (const SceneRecord::Object& object : scene_->run.objects)
      add (boxLines (*scene_, object, view.surface, stamp));
  const vtkSmartPointer<vtkPolyData> data = toPolyData (lines);
  if (!lines_)
  {
    lines_ = makeActor (data);
    lines_->GetProperty ()->SetLineWidth (line_px);
    lines_->GetProperty ()->LightingOff ();
    renderer_.AddActor (lines_);
  }
  vtkPolyDataMapper::SafeDownCast (lines_->GetMapper ())->SetInputData (data);
  lines_->SetVisibility (!lines.empty ());
}

void
WindowScene::showPoints (const std::shared_ptr<const FramePoints>& points)
{
  if (points_)
    points_->SetVisibility (points != nullptr);
  if (!points || points == shown_points_)
    return;
  const vtkSmartPointer<vtkPolyData> data = toPolyData (*points);
  if (!points_)
  {
    points_ = makeActor (data);
    points_->GetProperty ()->SetPointSize (point_px);
    points_->GetProperty ()->LightingOff ();
    renderer_.AddActor (points_);
  }
  vtkPolyDataMapper::SafeDownCast (points_->GetMapper ())->SetInputData (data);
  shown_points_ = points;
}

void
WindowScene::showSlices (double stamp, const SliceChoice& slices, int threads)
{
  const TriangleMesh& mesh = scene_->surface (slices.object, SurfaceMode::Completed);
  const auto object = std::find_if (scene_->run.objects.begin (), scene_->run.objects.end (),
                                    [&] (const SceneRecord::Object& o) { return o.id == slices.object; });
  const bool is_shown = slices.shown && !mesh.empty () && object != scene_->run.objects.end ();
  const std::optional<Eigen::Isometry3d> pose = is_shown ? scene_->poseAt (*object, stamp) : std::nullopt;
  const bool is_new = is_shown && (!sdf_ || sdf_object_ != slices.object);
  if (is_new)
  {
    sdf_.emplace (mesh, 72, threads);
    sdf_object_ = slices.object;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkSmartPointer<vtkActor>& actor = slice_actors_[static_cast<std::size_t> (axis)];
    const std::size_t a = static_cast<std::size_t> (axis);
    if (is_shown && pose && slices.axes[a] && (is_new || !actor || slices.shares[a] != drawn_slices_.shares[a]))
    {
      if (actor)
        renderer_.RemoveActor (actor);
      actor = makeActor (sdf_->slice (axis, slices.shares[a]));
      drawn_slices_.shares[a] = slices.shares[a];
      renderer_.AddActor (actor);
    }
    if (!actor)
      continue;
    actor->SetVisibility (is_shown && pose && slices.axes[a]);
    if (pose)
      actor->SetUserMatrix (toMatrix (*pose));
  }
}

void
WindowScene::update (double stamp, const SceneView& view, const SliceChoice& slices,
                     const std::shared_ptr<const FramePoints>& points, int threads)
{
  for (const auto& [key, surface] : surfaces_)
    surface.actor->SetVisibility (false);
  if (vtkActor* background = view.background ? surface (RunScene::background, view.surface, view.colour) : nullptr)
    background->SetVisibility (true);
  for (const SceneRecord::Object& object : scene_->run.objects)
  {
    const std::optional<Eigen::Isometry3d> pose = scene_->poseAt (object, stamp);
    vtkActor* actor = view.objects && pose ? surface (object.id, view.surface, view.colour) : nullptr;
    if (!actor)
      continue;
    actor->SetUserMatrix (toMatrix (*pose));
    actor->SetVisibility (true);
    actor->GetProperty ()->SetOpacity (slices.shown && slices.object == object.id ? seen_through : 1.0);
  }
  showLines (stamp, view);
  showPoints (view.surface == SurfaceMode::Points ? points : std::shared_ptr<const FramePoints> ());
  showSlices (stamp, slices, threads);
}

} // namespace pcl::cosection
