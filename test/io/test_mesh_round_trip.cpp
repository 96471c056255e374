// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Closed meshes, also simplified ones, are closed when VTK and PCL read them from any format.

#include "common/temporary_folder.h"
#include "volume/analytic_fields.h"

#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <pcl/io/vtk_lib_io.h>

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>

#include <array>
#include <map>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief The mesh with merged vertices; STL has three vertices for each triangle. */
TriangleMesh
welded (const TriangleMesh& mesh)
{
  TriangleMesh result;
  std::map<std::array<float, 3>, std::uint32_t> places;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    TriangleMesh::Triangle corners;
    for (int c = 0; c < 3; ++c)
    {
      const Eigen::Vector3f& v = mesh.vertices[t[c]];
      const auto next = static_cast<std::uint32_t> (result.vertices.size ());
      const auto [place, fresh] = places.emplace (std::array<float, 3>{v.x (), v.y (), v.z ()}, next);
      if (fresh)
        result.vertices.push_back (v);
      corners[c] = place->second;
    }
    result.triangles.push_back (corners);
  }
  return result;
}

template <typename Reader>
TriangleMesh
readByVtk (const std::string& path)
{
  vtkNew<Reader> reader;
  reader->SetFileName (path.c_str ());
  reader->Update ();
  vtkPolyData* const data = reader->GetOutput ();
  TriangleMesh mesh;
  for (vtkIdType v = 0; v < data->GetNumberOfPoints (); ++v)
    mesh.vertices.push_back (Eigen::Map<const Eigen::Vector3d> (data->GetPoint (v)).cast<float> ());
  vtkNew<vtkIdList> corners;
  data->GetPolys ()->InitTraversal ();
  while (data->GetPolys ()->GetNextCell (corners))
  {
    EXPECT_EQ (corners->GetNumberOfIds (), 3);
    mesh.triangles.push_back ({static_cast<std::uint32_t> (corners->GetId (0)),
                               static_cast<std::uint32_t> (corners->GetId (1)),
                               static_cast<std::uint32_t> (corners->GetId (2))});
  }
  return mesh;
}

TriangleMesh
readByPcl (const std::string& path)
{
  pcl::PolygonMesh mesh;
  EXPECT_GT (pcl::io::loadPolygonFile (path, mesh), 0u) << path;
  return fromPolygonMesh (mesh);
}

void
expectSame (const TriangleMesh& read, const TriangleMesh& written, const std::string& what)
{
  const TriangleMesh mesh = welded (read);
  EXPECT_EQ (mesh.triangles.size (), written.triangles.size ()) << what;
  const MeshTopology topology = computeTopology (mesh);
  EXPECT_TRUE (topology.closed_manifold) << what;
  EXPECT_EQ (topology.euler, computeTopology (written).euler) << what;
  const double volume = computeMassProperties (written).volume_m3;
  EXPECT_NEAR (computeMassProperties (mesh).volume_m3, volume, 1e-5 * volume) << what;
}

} // namespace

TEST (MeshRoundTrip, ClosedMeshesAreClosedForOthers)
{
  const TemporaryFolder folder;
  const TriangleMesh shapes[] = {extractIsoSurface (sampleField (sphere (0.06), 0.08, 0.004)),
                                 extractIsoSurface (sampleField (torus (0.06, 0.02), 0.1, 0.004))};
  for (const TriangleMesh& shape : shapes)
    for (const std::size_t triangles : {shape.triangles.size (), std::size_t (800), std::size_t (100)})
    {
      const TriangleMesh mesh = decimate (shape, triangles);
      ASSERT_LE (mesh.triangles.size (), triangles);
      const std::string ply = folder.file ("mesh.ply"), stl = folder.file ("mesh.stl"), obj = folder.file ("mesh.obj");
      for (const std::string& path : {ply, stl, obj})
      {
        saveMesh (mesh, path);
        expectSame (readByPcl (path), mesh, "PCL: " + path);
        expectSame (loadMesh (path), mesh, path);
      }
      expectSame (readByVtk<vtkPLYReader> (ply), mesh, "VTK: " + ply);
      expectSame (readByVtk<vtkSTLReader> (stl), mesh, "VTK: " + stl);
      expectSame (readByVtk<vtkOBJReader> (obj), mesh, "VTK: " + obj);
    }
}
