// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/temporary_folder.h"
#include "vtk_mesh_files.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

using namespace pcl::cosection;
using test::messageOf;
using test::Polygons;
using test::readFile;
using test::TemporaryFolder;
using test::VtkFile;
using test::writeFile;

namespace {

/** \brief Files of every format and encoding, by their paths. */
std::vector<std::string>
smallFiles (const TemporaryFolder& folder)
{
  Polygons polygons;
  polygons.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.75f}};
  polygons.polygons = {{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  std::vector<std::string> paths;
  for (const VtkFile file : test::vtkFiles ())
  {
    paths.push_back (folder.file (std::to_string (paths.size ()) + test::extensionOf (file)));
    test::writeWithVtk (polygons, file, paths.back ());
  }
  paths.push_back (folder.file ("text.off"));
  writeFile (paths.back (), test::tetrahedronOff ());
  return paths;
}

/** \brief The result is a valid mesh, or an error of one line. */
bool
loads (const std::string& path)
{
  try
  {
    const TriangleMesh mesh = loadMesh (path);
    EXPECT_FALSE (mesh.empty ());
    EXPECT_NO_THROW (computeTopology (mesh));
    for (const auto& v : mesh.vertices)
      EXPECT_TRUE (v.allFinite ());
    return true;
  }
  catch (const IoError& error)
  {
    EXPECT_EQ (std::string (error.what ()).rfind ("cannot read '" + path + "': ", 0), 0u) << error.what ();
    EXPECT_EQ (std::string (error.what ()).find ('\n'), std::string::npos) << error.what ();
    return false;
  }
}

} // namespace

TEST (MeshReaderErrors, SaysWhatIsWrong)
{
  const TemporaryFolder folder;
  const auto reasonFor = [&] (const std::string& name, const std::string& bytes) {
    const auto path = folder.file (name);
    writeFile (path, bytes);
    const auto message = messageOf<IoError> ([&] { loadMesh (path); });
    const std::string begin = "cannot read '" + path + "': ";
    EXPECT_EQ (message.rfind (begin, 0), 0u) << message;
    return message.substr (begin.size ());
  };
  EXPECT_EQ (messageOf<IoError> ([&] { loadMesh (folder.file ("none.ply")); }),
             "cannot read '" + folder.file ("none.ply") + "': No such file or directory");
  EXPECT_EQ (messageOf<IoError> ([&] { loadMesh (folder.file ("")); }),
             "cannot read '" + folder.file ("") + "': Is a directory");
  for (const char* extension : {".ply", ".stl", ".obj", ".off", ".vtk", ".vtp", ".xyz"})
    EXPECT_EQ (reasonFor (std::string ("empty") + extension, ""), "it is empty");
  const std::string unknown = "unknown format; known are .ply, .stl, .obj, .off, .vtk and .vtp";
  EXPECT_EQ (reasonFor ("mesh.xyz", "0 0 0\n"), unknown);
  EXPECT_EQ (reasonFor ("mesh", "0 0 0\n"), unknown);
  EXPECT_EQ (reasonFor ("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "it has no triangles");
  EXPECT_EQ (reasonFor ("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "all its triangles are without area");
  EXPECT_EQ (reasonFor ("short.obj", "v 0 0 0\nv 1 0\n"), "it ends where a number should be");
  EXPECT_EQ (reasonFor ("word.obj", "v 0 zero 0\n"), "'zero' is not a number");
  const std::string missing = "a face refers to a vertex that does not exist";
  for (const char* face : {"f 1 2 4", "f 0 1 2", "f 1 2 -4", "f 1 2 99999999999"})
    EXPECT_EQ (reasonFor ("index.obj", std::string ("v 0 0 0\nv 1 0 0\nv 0 1 0\n") + face + "\n"), missing) << face;
  EXPECT_EQ (reasonFor ("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), missing);
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                          "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ (reasonFor ("index.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"), missing);
  EXPECT_EQ (reasonFor ("short.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1"),
             "the PLY file is shorter than its header says");
  const std::string vtk = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
                          "0 0 0 1 0 0 0 1 0\n";
  EXPECT_EQ (reasonFor ("index.vtk", vtk + "POLYGONS 1 4\n3 0 1 3\n"), missing);
  EXPECT_EQ (reasonFor ("size.vtk", vtk + "POLYGONS 1 4\n4 0 1 2\n"),
             "a cell of the VTK file has an impossible number of corners");
  EXPECT_EQ (reasonFor ("grid.vtk", "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"),
             "the VTK file holds 'UNSTRUCTURED_GRID', not POLYDATA");
  EXPECT_EQ (reasonFor ("grid.vtp", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\"/>\n"),
             "the VTK file does not hold PolyData");
  EXPECT_EQ (reasonFor ("words.stl", "solid a\nfacet normal 0 0 1\nouter circle\n"),
             "'circle' is not a word of an STL file");

  // Coordinates that are not finite are errors if a face uses them.
  for (const char* number : {"nan", "inf", "-inf", "1e39", "1e999"})
    EXPECT_EQ (reasonFor ("number.obj", std::string ("v 0 0 0\nv 1 0 0\nv 0 1 ") + number + "\nf 1 2 3\n"),
               "vertex 2 (from 0) is not finite")
        << number;
  writeFile (folder.file ("unused.obj"), "v nan nan nan\nv 0 0 0\nv 1 0 0\nv 0 1 1e-999\nf 2 3 4\n");
  EXPECT_EQ (loadMesh (folder.file ("unused.obj")).vertices.size (), 3u);
}

TEST (MeshReaderErrors, FilesCutOffAnywhereAreRefusedOrRead)
{
  const TemporaryFolder folder;
  const TemporaryFolder cut;
  for (const std::string& path : smallFiles (folder))
  {
    ASSERT_TRUE (loads (path)) << path;
    const std::string bytes = readFile (path);
    const std::string part = cut.file (std::filesystem::path (path).filename ().string ());
    std::size_t refused = 0;
    testing::internal::CaptureStderr ();
    for (std::size_t size = 0; size < bytes.size (); ++size)
    {
      writeFile (part, bytes.substr (0, size));
      refused += !loads (part);
    }
    EXPECT_EQ (testing::internal::GetCapturedStderr (), "") << path;
    EXPECT_GT (refused, bytes.size () / 4) << path;
    const std::string extension = std::filesystem::path (path).extension ().string ();
    if (extension == ".ply" || extension == ".stl")
    {
      EXPECT_GE (refused + 2, bytes.size ()) << path; // they end with what is needed, and perhaps a new line
    }
  }
}

TEST (MeshReaderErrors, DamagedFilesNeverCrash)
{
  const TemporaryFolder folder;
  const TemporaryFolder damaged;
  std::mt19937 random (1);
  for (const std::string& path : smallFiles (folder))
  {
    const std::string good = readFile (path);
    const std::string spoiled = damaged.file (std::filesystem::path (path).filename ().string ());
    testing::internal::CaptureStderr ();
    for (int trial = 0; trial < 200; ++trial)
    {
      std::string bytes = good;
      for (int n = 0; n < 3; ++n)
        bytes[random () % bytes.size ()] = static_cast<char> (trial % 2 == 0 ? random () : '0' + random () % 10);
      writeFile (spoiled, bytes);
      loads (spoiled);
    }
    EXPECT_EQ (testing::internal::GetCapturedStderr (), "") << path;
  }
}
