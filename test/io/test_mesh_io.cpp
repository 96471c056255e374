// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <sstream>

using namespace pcl::cosection;
using test::messageOf;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

namespace {

TriangleMesh
tetrahedron ()
{
  TriangleMesh mesh;
  mesh.vertices = {{0.1f, 0, 0}, {1, 0, 1e-7f}, {0, 1, 0}, {0, 0, 1234.5678f}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TriangleMesh
fullTetrahedron ()
{
  auto mesh = tetrahedron ();
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0.6f, 0, 0.8f}};
  mesh.colours = {{1, 2, 3}, {255, 0, 128}, {10, 13, 26}, {0, 0, 0}}; // among them line ends
  mesh.confidence = {0.0f, 0.25f, 1.0f, 0.125f};
  mesh.sigma_m = {0.001f, 0.002f, 0.5f, 1e-9f};
  mesh.provenance = {0, 1, 2, 3};
  return mesh;
}

void
expectEqual (const TriangleMesh& a, const TriangleMesh& b)
{
  EXPECT_EQ (a.vertices, b.vertices);
  EXPECT_EQ (a.triangles, b.triangles);
  EXPECT_EQ (a.normals, b.normals);
  EXPECT_EQ (a.colours, b.colours);
  EXPECT_EQ (a.confidence, b.confidence);
  EXPECT_EQ (a.sigma_m, b.sigma_m);
  EXPECT_EQ (a.provenance, b.provenance);
}

/** \brief A PLY file of one triangle whose header and data can be spoiled. */
std::string
smallPly (const std::string& vertex_count, const std::string& face_count, int last_index, std::uint8_t corners = 3)
{
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + vertex_count +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " + face_count +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  bytes.append (reinterpret_cast<const char*> (positions), sizeof (positions));
  bytes += static_cast<char> (corners);
  const std::int32_t indices[3] = {0, 1, last_index};
  bytes.append (reinterpret_cast<const char*> (indices), sizeof (indices));
  return bytes;
}

} // namespace

TEST (MeshIo, PlyKeepsEveryVertexProperty)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("mesh.PLY");
  auto only_confidence = tetrahedron ();
  only_confidence.confidence = {1, 2, 3, 4};
  for (const auto& mesh : {tetrahedron (), fullTetrahedron (), only_confidence, TriangleMesh ()})
  {
    saveMesh (mesh, path);
    expectEqual (loadPlyMesh (path), mesh);
  }
  EXPECT_EQ (folder.entries (), 1u);
}

TEST (MeshIo, PlyHeaderIsTheDocumentedOne)
{
  const TemporaryFolder folder;
  saveMesh (fullTetrahedron (), folder.file ("mesh.ply"));
  const auto bytes = readFile (folder.file ("mesh.ply"));
  EXPECT_EQ (bytes.rfind ("ply\nformat binary_little_endian 1.0\nelement vertex 4\n", 0), 0u);
  for (const char* line : {"property float nx\n", "property uchar red\n", "property float confidence\n",
                           "property float sigma_m\n", "property uchar provenance\n", "element face 4\n"})
    EXPECT_NE (bytes.find (line), std::string::npos) << line;
}

TEST (MeshIo, PlyOfOthersMayHaveMorePropertiesAndOtherTypes)
{
  std::string bytes = "ply\r\nformat binary_little_endian 1.0\r\ncomment by hand\r\nelement vertex 3\r\n"
                      "property double x\r\nproperty double y\r\nproperty short quality\r\nproperty double z\r\n"
                      "element face 1\r\nproperty uchar flags\r\nproperty list uchar uint vertex_index\r\n"
                      "element edge 0\r\nproperty int vertex1\r\nend_header\r\n";
  for (int n = 0; n < 3; ++n)
  {
    const double xy[2] = {1.0 * n, 2.0 * n};
    const std::int16_t quality = -7;
    const double z = 3.0 * n;
    bytes.append (reinterpret_cast<const char*> (xy), 16);
    bytes.append (reinterpret_cast<const char*> (&quality), 2);
    bytes.append (reinterpret_cast<const char*> (&z), 8);
  }
  bytes += '\x42';
  bytes += '\x03';
  const std::uint32_t indices[3] = {2, 1, 0};
  bytes.append (reinterpret_cast<const char*> (indices), 12);
  const TemporaryFolder folder;
  writeFile (folder.file ("a.ply"), bytes);
  const auto mesh = loadPlyMesh (folder.file ("a.ply"));
  ASSERT_EQ (mesh.vertices.size (), 3u);
  EXPECT_EQ (mesh.vertices[2], Eigen::Vector3f (2, 4, 6));
  ASSERT_EQ (mesh.triangles.size (), 1u);
  EXPECT_EQ (mesh.triangles[0], (TriangleMesh::Triangle{2, 1, 0}));
}

TEST (MeshIo, MalformedPlyIsRefused)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("bad.ply");
  const auto reasonFor = [&] (const std::string& bytes) {
    writeFile (path, bytes);
    const auto message = messageOf<IoError> ([&] { loadPlyMesh (path); });
    EXPECT_EQ (message.rfind ("cannot read '" + path + "': ", 0), 0u) << message;
    return message.substr (message.rfind (": ") + 2);
  };
  writeFile (path, smallPly ("3", "1", 2));
  EXPECT_EQ (loadPlyMesh (path).triangles.size (), 1u);

  const std::string too_short = "the PLY file is shorter than its header says";
  EXPECT_EQ (reasonFor (""), "not a PLY file");
  EXPECT_EQ (reasonFor ("# .PCD v0.7\n"), "not a PLY file");
  EXPECT_EQ (reasonFor ("ply\nformat binary_little_endian 1.0\n"), "the PLY header does not end");
  EXPECT_EQ (reasonFor (smallPly ("18446744073709551615", "1", 2)), too_short);
  EXPECT_EQ (reasonFor (smallPly ("-1", "1", 2)), too_short);
  EXPECT_EQ (reasonFor (smallPly ("4000000000", "1", 2)), too_short);
  EXPECT_EQ (reasonFor (smallPly ("3", "9000000000000000000", 2)), too_short);
  EXPECT_EQ (reasonFor (smallPly ("99999999999999999999999", "1", 2)), "an element of the PLY header has no count");
  EXPECT_EQ (reasonFor (smallPly ("3", "1", 3)), "a face refers to a vertex that does not exist");
  EXPECT_EQ (reasonFor (smallPly ("3", "1", -1)), "a face refers to a vertex that does not exist");
  EXPECT_EQ (reasonFor (smallPly ("3", "1", 2, 2)), "a face is not a triangle");
  EXPECT_EQ (reasonFor (smallPly ("3", "1", 2, 255)), too_short);
  EXPECT_EQ (reasonFor ("ply\nformat mixed 1.0\nend_header\n"),
             "PLY format 'mixed' is not supported, only ascii, binary_little_endian and binary_big_endian");
  EXPECT_EQ (reasonFor ("ply\nformat binary_little_endian 1.0\nelement vertex 9\nend_header\n"),
             "the vertices have no x, y and z");
  EXPECT_EQ (reasonFor ("ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                        "property float z\nelement face 9000000000000000000\nend_header\n"),
             "the faces have no vertex_indices");
}

TEST (MeshIo, DamagedPlyNeverCrashes)
{
  const TemporaryFolder folder;
  saveMesh (fullTetrahedron (), folder.file ("good.ply"));
  const std::string good = readFile (folder.file ("good.ply"));
  const auto path = folder.file ("bad.ply");
  for (std::size_t size = 0; size < good.size (); ++size)
  {
    writeFile (path, good.substr (0, size));
    EXPECT_THROW (loadPlyMesh (path), IoError) << size;
  }
  std::mt19937 random (1);
  for (int trial = 0; trial < 2000; ++trial)
  {
    std::string bytes = good;
    for (int n = 0; n < 3; ++n)
      bytes[random () % bytes.size ()] = static_cast<char> (random ());
    writeFile (path, bytes);
    try
    {
      computeTopology (loadPlyMesh (path)); // a mesh that is read is consistent
    }
    catch (const IoError&)
    {}
  }
}

TEST (MeshIo, StlHoldsFacesWithTheirNormals)
{
  const TemporaryFolder folder;
  const auto mesh = tetrahedron ();
  saveMesh (mesh, folder.file ("mesh.stl"));
  const auto bytes = readFile (folder.file ("mesh.stl"));
  ASSERT_EQ (bytes.size (), 84u + 50u * 4u);
  EXPECT_NE (bytes.substr (0, 5), "solid");
  std::uint32_t count = 0;
  std::memcpy (&count, &bytes[80], 4);
  EXPECT_EQ (count, 4u);
  float record[12];
  std::memcpy (record, &bytes[84], sizeof (record));
  EXPECT_NEAR (record[2], -1.0f, 1e-5f); // the bottom looks down
  for (int n = 0; n < 3; ++n)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ (record[3 + 3 * n + axis], mesh.vertices[mesh.triangles[0][n]][axis]);
}

TEST (MeshIo, ObjHoldsTheSameNumbers)
{
  const TemporaryFolder folder;
  const auto mesh = fullTetrahedron ();
  saveMesh (mesh, folder.file ("mesh.obj"));
  std::istringstream lines (readFile (folder.file ("mesh.obj")));
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::string> faces;
  for (std::string line; std::getline (lines, line);)
  {
    std::istringstream words (line);
    std::string keyword;
    words >> keyword;
    Eigen::Vector3f v;
    if (keyword == "f")
      faces.push_back (line);
    else if (words >> v[0] >> v[1] >> v[2])
      (keyword == "v" ? vertices : normals).push_back (v);
  }
  EXPECT_EQ (vertices, mesh.vertices);
  EXPECT_EQ (normals, mesh.normals);
  ASSERT_EQ (faces.size (), 4u);
  EXPECT_EQ (faces[0], "f 1//1 3//3 2//2");
}

TEST (MeshIo, RefusesWhatItCannotWrite)
{
  const TemporaryFolder folder;
  EXPECT_NE (messageOf<InvalidArgument> ([&] { saveMesh (tetrahedron (), folder.file ("mesh.xyz")); }).find (".ply"),
             std::string::npos);
  auto broken = tetrahedron ();
  broken.triangles[0][0] = 4;
  EXPECT_THROW (saveMesh (broken, folder.file ("mesh.ply")), InvalidArgument);
  auto uneven = tetrahedron ();
  uneven.confidence = {1.0f};
  EXPECT_THROW (saveMesh (uneven, folder.file ("mesh.ply")), InvalidArgument);
  uneven = tetrahedron ();
  uneven.sigma_m = {0.001f};
  EXPECT_THROW (saveMesh (uneven, folder.file ("mesh.ply")), InvalidArgument);
  EXPECT_THROW (saveMesh (tetrahedron (), folder.file ("no/mesh.ply")), IoError);
  EXPECT_THROW (loadPlyMesh (folder.file ("none.ply")), IoError);
  EXPECT_THROW (loadPlyMesh (folder.file ("")), IoError);
  EXPECT_EQ (folder.entries (), 0u);
}

TEST (MeshIo, FullDiskLeavesNothing)
{
  const TemporaryFolder folder;
  std::string message;
  {
    const test::FileSizeLimit limit (100);
    message = messageOf<IoError> ([&] { saveMesh (tetrahedron (), folder.file ("mesh.ply")); });
  }
  EXPECT_EQ (message, "cannot write '" + folder.file ("mesh.ply") + "': File too large");
  EXPECT_EQ (folder.entries (), 0u);
}
