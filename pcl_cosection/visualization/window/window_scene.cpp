// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "window_scene.h"

#include "pcl_cosection/visualization/scene_legend.h"
#include "pcl_cosection/visualization/scene_lines.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double ambient_light = 0.35; ///< the rest comes from the head light, as in drawScene ()
constexpr double seen_through = 0.25;  ///< opacity of the object that is cut
constexpr float line_px = 2.0f;        ///< and of points

vtkSmartPointer<vtkPoints>
toPoints (const std::vector<Eigen::Vector3f>& points)
{
  auto result = vtkSmartPointer<vtkPoints>::New ();
  result->SetDataTypeToFloat ();
  result->SetNumberOfPoints (static_cast<vtkIdType> (points.size ()));
  for (std::size_t n = 0; n < points.size (); ++n)
    result->SetPoint (static_cast<vtkIdType> (n), points[n].x (), points[n].y (), points[n].z ());
  return result;
}

/** \brief Pixels in the order of VTK's images. */
vtkSmartPointer<vtkImageData>
toImage (const Picture& picture)
{
  auto image = vtkSmartPointer<vtkImageData>::New ();
  image->SetDimensions (picture.width, picture.height, 1);
  image->AllocateScalars (VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*> (image->GetScalarPointer ());
  for (const auto& pixel : picture.pixels)
    out = std::copy_n (pixel.begin (), 3, out);
  return image;
}

vtkSmartPointer<vtkUnsignedCharArray>
toColours (const std::vector<TriangleMesh::Colour>& colours)
{
  auto result = vtkSmartPointer<vtkUnsignedCharArray>::New ();
  result->SetName ("colours");
  result->SetNumberOfComponents (3);
  result->SetNumberOfTuples (static_cast<vtkIdType> (colours.size ()));
  auto* out = result->GetPointer (0);
  for (const TriangleMesh::Colour& colour : colours)
    out = std::copy_n (colour.begin (), 3, out);
  return result;
}

vtkSmartPointer<vtkPolyData>
toPolyData (const TriangleMesh& mesh)
{
  auto data = vtkSmartPointer<vtkPolyData>::New ();
  data->SetPoints (toPoints (mesh.vertices));
  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact (static_cast<vtkIdType> (mesh.triangles.size ()),
                            3 * static_cast<vtkIdType> (mesh.triangles.size ()));
  for (const TriangleMesh::Triangle& t : mesh.triangles)
    triangles->InsertNextCell ({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
  data->SetPolys (triangles);
  if (mesh.normals.size () == mesh.vertices.size ())
  {
    vtkNew<vtkFloatArray> normals;
    normals->SetNumberOfComponents (3);
    normals->SetNumberOfTuples (static_cast<vtkIdType> (mesh.normals.size ()));
    for (std::size_t n = 0; n < mesh.normals.size (); ++n)
      normals->SetTypedTuple (static_cast<vtkIdType> (n), mesh.normals[n].data ());
    data->GetPointData ()->SetNormals (normals);
  }
  return data;
}

vtkSmartPointer<vtkPolyData>
toPolyData (const std::vector<SceneLine>& lines)
{
  std::vector<Eigen::Vector3f> points;
  std::vector<TriangleMesh::Colour> colours;
  vtkNew<vtkCellArray> cells;
  for (const SceneLine& line : lines)
  {
    const auto first = static_cast<vtkIdType> (points.size ());
    cells->InsertNextCell ({first, first + 1});
    points.insert (points.end (), {line.begin.cast<float> (), line.end.cast<float> ()});
    colours.insert (colours.end (), 2, line.colour);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New ();
  data->SetPoints (toPoints (points));
  data->SetLines (cells);
  data->GetPointData ()->SetScalars (toColours (colours));
  return data;
}

vtkSmartPointer<vtkPolyData>
toPolyData (const FramePoints& points)
{
  vtkNew<vtkCellArray> cells;
  for (std::size_t n = 0; n < points.points.size (); ++n)
    cells->InsertNextCell ({static_cast<vtkIdType> (n)});
  auto data = vtkSmartPointer<vtkPolyData>::New ();
  data->SetPoints (toPoints (points.points));
  data->SetVerts (cells);
  data->GetPointData ()->SetScalars (toColours (points.colours));
  return data;
}

vtkSmartPointer<vtkMatrix4x4>
toMatrix (const Eigen::Isometry3d& pose)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New ();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      matrix->SetElement (row, column, pose.matrix () (row, column));
  return matrix;
}

vtkSmartPointer<vtkActor>
makeActor (vtkPolyData* data)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData (data);
  mapper->SetColorModeToDirectScalars ();
  auto actor = vtkSmartPointer<vtkActor>::New ();
  actor->SetMapper (mapper);
  return actor;
}

vtkSmartPointer<vtkActor>
makeActor (const SdfSlice& slice)
{
  vtkNew<vtkPolyData> data;
  data->SetPoints (toPoints ({slice.corners.begin (), slice.corners.end ()}));
  vtkNew<vtkCellArray> quad;
  quad->InsertNextCell ({vtkIdType{0}, vtkIdType{1}, vtkIdType{2}, vtkIdType{3}});
  data->SetPolys (quad);
  vtkNew<vtkFloatArray> places;
  places->SetNumberOfComponents (2);
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
    places->InsertNextTuple2 (u, v);
  data->GetPointData ()->SetTCoords (places);
  vtkNew<vtkTexture> texture;
  texture->SetInputData (toImage (slice.picture));
  texture->InterpolateOn ();
  vtkSmartPointer<vtkActor> actor = makeActor (data);
  actor->SetTexture (texture);
  actor->GetProperty ()->LightingOff ();
  return actor;
}

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
WindowScene::show (vtkPolyData* data, vtkSmartPointer<vtkActor>& actor)
{
  if (!actor)
  {
    actor = makeActor (data);
    actor->GetProperty ()->SetLineWidth (line_px);
    actor->GetProperty ()->SetPointSize (line_px);
    actor->GetProperty ()->LightingOff ();
    renderer_.AddActor (actor);
  }
  vtkPolyDataMapper::SafeDownCast (actor->GetMapper ())->SetInputData (data);
}

void
WindowScene::showPoints (const std::shared_ptr<const FramePoints>& points)
{
  if (points_)
    points_->SetVisibility (points != nullptr);
  if (!points || points == shown_points_)
    return;
  show (toPolyData (*points), points_);
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
  for (std::size_t a = 0; a < slice_actors_.size (); ++a)
  {
    vtkSmartPointer<vtkActor>& actor = slice_actors_[a];
    if (is_shown && pose && slices.axes[a] && (is_new || !actor || slices.shares[a] != drawn_slices_.shares[a]))
    {
      if (actor)
        renderer_.RemoveActor (actor);
      actor = makeActor (sdf_->slice (static_cast<int> (a), slices.shares[a]));
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
  const std::vector<SceneLine> lines = linesOf (*scene_, stamp, view);
  show (toPolyData (lines), lines_);
  lines_->SetVisibility (!lines.empty ());
  showPoints (view.surface == SurfaceMode::Points ? points : std::shared_ptr<const FramePoints> ());
  showSlices (stamp, slices, threads);
}

} // namespace pcl::cosection
