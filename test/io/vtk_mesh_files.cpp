// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtk_mesh_files.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkXMLPolyDataWriter.h>

namespace pcl::cosection::test {
namespace {

vtkNew<vtkCellArray>
cells (const std::vector<std::vector<int>>& lists)
{
  vtkNew<vtkCellArray> result;
  for (const auto& list : lists)
  {
    result->InsertNextCell (static_cast<int> (list.size ()));
    for (const int n : list)
      result->InsertCellPoint (n);
  }
  return result;
}

template <typename Writer>
void
write (Writer& writer, vtkPolyData& data, const std::string& path)
{
  writer.SetInputData (&data);
  writer.SetFileName (path.c_str ());
  writer.Write ();
}

} // namespace

std::vector<VtkFile>
vtkFiles ()
{
  return {VtkFile::PlyAscii,        VtkFile::PlyLittleEndian, VtkFile::PlyBigEndian,
          VtkFile::StlAscii,        VtkFile::StlBinary,       VtkFile::Obj,
          VtkFile::LegacyAscii,     VtkFile::LegacyBinary,    VtkFile::OldLegacyAscii,
          VtkFile::OldLegacyBinary, VtkFile::XmlAscii,        VtkFile::XmlBinary,
          VtkFile::XmlAppended,     VtkFile::XmlRaw};
}

std::string
extensionOf (VtkFile file)
{
  if (file <= VtkFile::PlyBigEndian)
    return ".ply";
  if (file <= VtkFile::StlBinary)
    return ".stl";
  if (file == VtkFile::Obj)
    return ".obj";
  return file <= VtkFile::OldLegacyBinary ? ".vtk" : ".vtp";
}

std::string
tetrahedronOff ()
{
  return "OFF # a tetrahedron\n\n4 4 6\n0 0 0\n1 0 0  0.5 0.5 0.5\n0 1 0\n# the top\n0 0 1\n3 0 2 1\n3 0 1 3 255 0 0\n"
         "3 1 2 3\n3 0 3 2\n";
}

void
writeWithVtk (const Polygons& polygons, VtkFile file, const std::string& path)
{
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> heights; // a file has more than positions
  heights->SetName ("height");
  for (const auto& p : polygons.points)
  {
    points->InsertNextPoint (p.x (), p.y (), p.z ());
    heights->InsertNextValue (p.z ());
  }
  data->SetPoints (points);
  data->SetPolys (cells (polygons.polygons));
  data->SetStrips (cells (polygons.strips));
  data->GetPointData ()->AddArray (heights);

  const std::string extension = extensionOf (file);
  if (extension == ".ply")
  {
    vtkNew<vtkPLYWriter> writer;
    if (file == VtkFile::PlyAscii)
      writer->SetFileTypeToASCII ();
    else
      writer->SetFileTypeToBinary ();
    if (file == VtkFile::PlyBigEndian)
      writer->SetDataByteOrderToBigEndian ();
    else
      writer->SetDataByteOrderToLittleEndian ();
    write (*writer, *data, path);
  }
  else if (extension == ".stl")
  {
    vtkNew<vtkSTLWriter> writer;
    writer->SetFileType (file == VtkFile::StlAscii ? VTK_ASCII : VTK_BINARY);
    write (*writer, *data, path);
  }
  else if (extension == ".obj")
  {
    vtkNew<vtkOBJWriter> writer;
    write (*writer, *data, path);
  }
  else if (extension == ".vtk")
  {
    vtkNew<vtkPolyDataWriter> writer;
    writer->SetFileType (file == VtkFile::LegacyAscii || file == VtkFile::OldLegacyAscii ? VTK_ASCII : VTK_BINARY);
    if (file == VtkFile::OldLegacyAscii || file == VtkFile::OldLegacyBinary)
      writer->SetFileVersion (vtkDataWriter::VTK_LEGACY_READER_VERSION_4_2);
    write (*writer, *data, path);
  }
  else
  {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetDataMode (file == VtkFile::XmlAscii    ? vtkXMLWriter::Ascii
                         : file == VtkFile::XmlBinary ? vtkXMLWriter::Binary
                                                      : vtkXMLWriter::Appended);
    if (file == VtkFile::XmlRaw)
    {
      writer->SetCompressorTypeToNone ();
      writer->EncodeAppendedDataOff ();
    }
    write (*writer, *data, path);
  }
}

} // namespace pcl::cosection::test
