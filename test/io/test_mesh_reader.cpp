// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/small_meshes.h"
#include "common/temporary_folder.h"
#include "vtk_mesh_files.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

using namespace pcl::cosection;
using test::Polygons;
using test::readFile;
using test::TemporaryFolder;
using test::VtkFile;
using test::writeFile;

namespace {

using Corner = std::array<float, 3>;

/** \brief The triangles by their coordinates, independent of their first corner. */
std::multiset<std::array<Corner, 3>>
trianglesOf (const TriangleMesh& mesh)
{
  std::multiset<std::array<Corner, 3>> triangles;
  for (const auto& triangle : mesh.triangles)
  {
    std::array<Corner, 3> corners;
    for (int n = 0; n < 3; ++n)
      std::copy_n (mesh.vertices[triangle[n]].data (), 3, corners[n].begin ());
    std::rotate (corners.begin (), std::min_element (corners.begin (), corners.end ()), corners.end ());
    triangles.insert (corners);
  }
  return triangles;
}

Polygons
polygonsOf (const TriangleMesh& mesh)
{
  Polygons polygons;
  polygons.points = mesh.vertices;
  for (const auto& triangle : mesh.triangles)
    polygons.polygons.push_back ({int (triangle[0]), int (triangle[1]), int (triangle[2])});
  return polygons;
}

/** \brief A box whose coordinates are short in the decimal system too. */
TriangleMesh
box ()
{
  return test::boxMesh ({-0.5f, 0.25f, 0.0f}, {1.5f, 1.25f, 0.125f});
}

constexpr double box_volume = 0.25;

TriangleMesh
flipped (TriangleMesh mesh, std::size_t every = 1)
{
  for (std::size_t t = 0; t < mesh.triangles.size (); t += every)
    std::swap (mesh.triangles[t][0], mesh.triangles[t][1]);
  return mesh;
}

} // namespace

TEST (MeshReader, ReadsWhatVtkWrites)
{
  const TemporaryFolder folder;
  for (const VtkFile file : test::vtkFiles ())
  {
    const std::string path = folder.file ("mesh" + test::extensionOf (file));
    test::writeWithVtk (polygonsOf (box ()), file, path);
    const TriangleMesh mesh = loadMesh (path);
    EXPECT_EQ (trianglesOf (mesh), trianglesOf (box ())) << path << ' ' << int (file);
    EXPECT_EQ (mesh.vertices.size (), 8u) << path;
    EXPECT_TRUE (computeTopology (mesh).closed_manifold) << path;
  }
}

TEST (MeshReader, ReadsWhatWeWrite)
{
  const TemporaryFolder folder;
  TriangleMesh mesh = test::torusMesh (0.1234567, 0.0456789, 12, 7);
  mesh.colours.assign (mesh.vertices.size (), {1, 2, 3});
  mesh.confidence.assign (mesh.vertices.size (), 0.5f);
  for (const char* name : {"mesh.ply", "mesh.STL", "mesh.obj"})
  {
    saveMesh (mesh, folder.file (name));
    EXPECT_EQ (trianglesOf (loadMesh (folder.file (name))), trianglesOf (mesh)) << name;
  }
}

TEST (MeshReader, PolygonsAreTriangulated)
{
  const TemporaryFolder folder;
  Polygons prism; // over a concave pentagon of area 0.75; its faces are quadrilaterals and pentagons
  prism.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5f, 0.5f, 0}, {0, 1, 0},
                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0.5f, 0.5f, 1}, {0, 1, 1}};
  prism.polygons = {{4, 3, 2, 1, 0}, {5, 6, 7, 8, 9}};
  for (int n = 0; n < 5; ++n)
    prism.polygons.push_back ({n, (n + 1) % 5, (n + 1) % 5 + 5, n + 5});
  for (const VtkFile file : test::vtkFiles ())
  {
    if (test::extensionOf (file) == ".stl")
      continue; // its writer converts them to triangles
    const std::string path = folder.file ("prism" + test::extensionOf (file));
    test::writeWithVtk (prism, file, path);
    const TriangleMesh mesh = loadMesh (path);
    EXPECT_EQ (mesh.triangles.size (), 16u) << path;
    EXPECT_TRUE (computeTopology (mesh).closed_manifold) << path;
    EXPECT_NEAR (computeMassProperties (mesh).volume_m3, 0.75, 1e-6) << path;
  }
}

TEST (MeshReader, TriangleStripsAreUnrolled)
{
  const TemporaryFolder folder;
  Polygons tube; // a tetrahedron in one strip
  tube.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tube.strips = {{0, 2, 1, 3, 0, 2}};
  for (const VtkFile file : {VtkFile::LegacyAscii, VtkFile::OldLegacyBinary, VtkFile::XmlAppended})
  {
    const std::string path = folder.file ("strip" + test::extensionOf (file));
    test::writeWithVtk (tube, file, path);
    const TriangleMesh mesh = loadMesh (path);
    EXPECT_TRUE (computeTopology (mesh).closed_manifold) << path;
    EXPECT_NEAR (computeMassProperties (mesh).volume_m3, 1.0 / 6.0, 1e-7) << path;
  }
  writeFile (folder.file ("strips.ply"),
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n0 1 0\n0 0 1\n9 0 2 1 3 -1 3 0 2 -1\n");
  EXPECT_EQ (loadMesh (folder.file ("strips.ply")).triangles.size (), 3u);
}

TEST (MeshReader, ReadsEveryKindOfOff)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("a.off");
  const std::string body = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::vector<std::string> texts = {"OFF\n" + body, "OFF " + body,
                                          "OFF" + body,   "STCNOFF\n" + body,
                                          body,           "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n"};
  for (const std::string& text : texts)
  {
    writeFile (path, text);
    EXPECT_EQ (loadMesh (path).triangles.size (), 1u) << text;
  }
  writeFile (path, test::tetrahedronOff ());
  EXPECT_TRUE (computeTopology (loadMesh (path)).closed_manifold);
  for (const char* text : {"4OFF\n3 1 0\n", "nOFF\n3 3 1 0\n", "OFF BINARY\n\1\2\3", "OFF\n", "OFF\n-1 1 0\n",
                           "OFF\n999999999999 1 0\n", "OFF\n3 99999999999999999999 0\n", "nonsense\n"})
  {
    writeFile (path, text);
    EXPECT_THROW (loadMesh (path), IoError) << text;
  }
}

TEST (MeshReader, ReadsObjOfOthers)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("a.obj");
  writeFile (path, "# by hand\r\nmtllib none.mtl\r\no part\r\nv +0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv 0 1e0 0\r\n"
                   "vt 0 0\r\nvn 0 0 1\r\nl 1 2\r\ns off\r\nf -3/1/1 \\\r\n -2//1 -1/1 # the last\r\nv 0 0 1\r\n"
                   "f 1 4 2\r\n");
  const TriangleMesh mesh = loadMesh (path);
  EXPECT_EQ (mesh.triangles.size (), 2u);
  EXPECT_EQ (mesh.vertices.size (), 4u);
}

TEST (MeshReader, TheContentsDecideOnTheFormat)
{
  const TemporaryFolder folder;
  for (const VtkFile file : {VtkFile::PlyAscii, VtkFile::LegacyBinary, VtkFile::XmlAscii})
    for (const char* name : {"mesh.dat", "mesh", "mesh.obj"})
    {
      const auto proper = folder.file ("proper" + test::extensionOf (file)); // VTK knows no other names
      test::writeWithVtk (polygonsOf (box ()), file, proper);
      std::filesystem::rename (proper, folder.file (name));
      EXPECT_EQ (loadMesh (folder.file (name)).triangles.size (), 12u) << name;
    }
  // The title of a binary STL file may be that of a text.
  saveMesh (box (), folder.file ("mesh.stl"));
  std::string bytes = readFile (folder.file ("mesh.stl"));
  bytes.replace (0, 12, "solid a name");
  writeFile (folder.file ("mesh.stl"), bytes);
  EXPECT_EQ (loadMesh (folder.file ("mesh.stl")).triangles.size (), 12u);
}

TEST (MeshReader, OrientationIsRepaired)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("mesh.stl");
  for (const std::size_t every : {1, 2, 3, 5, 12}) // all, some or one inside out
  {
    saveMesh (flipped (box (), every), path);
    EXPECT_EQ (trianglesOf (loadMesh (path)), trianglesOf (box ())) << every;
  }
  // An open sheet keeps the side of most of its triangles.
  TriangleMesh sheet = box ();
  sheet.triangles.erase (sheet.triangles.begin (), sheet.triangles.begin () + 2);
  TriangleMesh spoiled = sheet;
  std::swap (spoiled.triangles[3][0], spoiled.triangles[3][1]);
  saveMesh (spoiled, path);
  EXPECT_EQ (trianglesOf (loadMesh (path)), trianglesOf (sheet));
  saveMesh (flipped (sheet), path);
  EXPECT_EQ (trianglesOf (loadMesh (path)), trianglesOf (flipped (sheet)));
}

TEST (MeshReader, CavitiesStayAndBodiesFaceOutward)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("mesh.stl");
  TriangleMesh hollow = test::boxMesh ({-2, -2, -2}, {3, 3, 3});
  appendMesh (hollow, flipped (box ()));
  for (const TriangleMesh& mesh : {hollow, flipped (hollow)})
  {
    saveMesh (mesh, path);
    EXPECT_NEAR (computeMassProperties (loadMesh (path)).volume_m3, 125.0 - box_volume, 1e-5);
  }
  TriangleMesh apart = test::boxMesh ({5, 5, 5}, {6, 6, 6});
  appendMesh (apart, flipped (box ()));
  for (const TriangleMesh& mesh : {apart, flipped (apart)})
  {
    saveMesh (mesh, path);
    EXPECT_NEAR (computeMassProperties (loadMesh (path)).volume_m3, 1.0 + box_volume, 1e-5);
  }
}

TEST (MeshReader, TrianglesOfNoAreaLeaveNoGap)
{
  const TemporaryFolder folder;
  TriangleMesh mesh = box ();
  const auto add = [&mesh] (float x) {
    mesh.vertices.emplace_back (x, 0.25f, 0.125f); // on the edge from vertex 4 to vertex 5
    return static_cast<std::uint32_t> (mesh.vertices.size ()) - 1;
  };
  const std::uint32_t a = add (0.0f), b = add (0.5f);
  mesh.triangles[5] = {1, 5, b}; // of {1, 5, 4} on one side of the edge
  mesh.triangles.push_back ({1, b, a});
  mesh.triangles.push_back ({1, a, 4});
  mesh.triangles.push_back ({4, a, b}); // and of no area
  mesh.triangles.push_back ({4, b, 5});
  mesh.triangles.push_back ({a, a, b});
  mesh.triangles.push_back (mesh.triangles[0]); // repeated
  saveMesh (mesh, folder.file ("mesh.obj"));
  const TriangleMesh loaded = loadMesh (folder.file ("mesh.obj"));
  EXPECT_EQ (loaded.triangles.size (), 16u);
  EXPECT_TRUE (computeTopology (loaded).closed_manifold);
  EXPECT_NEAR (computeMassProperties (loaded).volume_m3, box_volume, 1e-6);
  for (const auto& t : loaded.triangles)
  {
    const Eigen::Vector3f u = loaded.vertices[t[1]] - loaded.vertices[t[0]];
    EXPECT_GT (u.cross (loaded.vertices[t[2]] - loaded.vertices[t[0]]).norm (), 0.0f);
  }
}
