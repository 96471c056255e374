// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtk_shapes.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTexture.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

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

} // namespace

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

} // namespace pcl::cosection
