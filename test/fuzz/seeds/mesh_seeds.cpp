// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_seeds.h"

#include "fuzz/memory_file.h"
#include "io/vtk_mesh_files.h"

#include <pcl/cosection/io/mesh_io.h>

#include <cstdint>

using namespace pcl::cosection;

namespace fuzz {
namespace {

template <typename T>
void
put (std::string& bytes, T value)
{
  bytes.append (reinterpret_cast<const char*> (&value), sizeof (value));
}

const float corners[4][3] = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
constexpr int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/** \brief A tetrahedron. \tparam Real of the positions \tparam Index of the corners */
template <typename Real, typename Index>
std::string
tetrahedron (const std::string& real, const std::string& index, const std::string& corners_name, bool properties)
{
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment a tetrahedron\nelement vertex 4\n";
  for (const char* name : {"x", "y", "z"})
    bytes += "property " + real + " " + name + "\n";
  if (properties)
    for (const char* name : {"float nx", "float ny", "float nz", "uchar red", "uchar green", "uchar blue",
                             "float confidence", "float sigma_m", "uchar provenance", "int unknown"})
      bytes += std::string ("property ") + name + "\n";
  bytes += "element face 4\nproperty list uchar " + index + " " + corners_name + "\n";
  if (properties)
    bytes += "property short flags\nproperty list ushort float weights\n";
  bytes += "end_header\n";
  for (const auto& corner : corners)
  {
    for (const float value : corner)
      put (bytes, static_cast<Real> (value));
    if (properties)
      bytes.append (3 * sizeof (float) + 3 + 2 * sizeof (float) + 1 + sizeof (int), '\1');
  }
  for (const auto& face : faces)
  {
    put (bytes, std::uint8_t{3});
    for (const int corner : face)
      put (bytes, static_cast<Index> (corner));
    if (properties)
    {
      put (bytes, std::int16_t{5});
      put (bytes, std::uint16_t{2});
      put (bytes, 0.5f);
      put (bytes, 0.25f);
    }
  }
  return (bytes);
}

/** \brief Bodies of polygons. */
test::Polygons
pyramids ()
{
  test::Polygons shape;
  shape.points = {{0, 0, 0},    {4, 0, 0},    {4, 4, 0},    {0, 4, 0}, {2, 2, 3},
                  {1, 1, 0.5f}, {2, 1, 0.5f}, {1, 2, 0.5f}, {1, 1, 1}, {4, 2, 0}};
  shape.polygons = {{3, 2, 9, 1, 0}, {0, 1, 4}, {1, 2, 4}, {1, 9, 2}, {2, 3, 4}, {3, 0, 4},
                    {5, 6, 7},       {5, 8, 6}, {6, 8, 7}, {7, 8, 5}, {7, 8, 5}};
  return (shape);
}

/** \brief Open: a concave polygon and a strip. */
test::Polygons
sheets ()
{
  test::Polygons shape;
  shape.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 1}, {2, 0, 1}, {0, 3, 1}};
  shape.polygons = {{0, 1, 2, 3, 4, 5}, {5, 4, 8}};
  shape.strips = {{0, 1, 6, 7, 8}};
  return (shape);
}

/** \brief Strips as scanners write them, ASCII. */
std::string
stripsPly ()
{
  return ("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n9 0 1 2 3 -1 0 1 4 -1\n");
}

std::string
relativeObj ()
{
  return ("# a tetrahedron\nmtllib none.mtl\no body\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\ng all\n"
          "usemtl red\ns off\nf -4/1/1 -2/1/1 -3/1/1\nf 1//1 2//1 4//1\nf 1/1 4/1 \\\n  3/1\nf 2 3 4\nl 1 2\np 1\n");
}

} // namespace

std::vector<MeshSeed>
meshSeeds ()
{
  std::vector<MeshSeed> seeds = {
      {".ply", tetrahedron<float, std::int32_t> ("float", "int", "vertex_indices", false)},
      {".ply", tetrahedron<double, std::uint8_t> ("double", "uchar", "vertex_index", false)},
      {".ply", tetrahedron<float, std::uint16_t> ("float32", "uint16", "vertex_indices", true)},
      {".ply", stripsPly ()},
      {".obj", relativeObj ()},
      {".off", test::tetrahedronOff ()},
      {".off", "STCNOFF 3 1 0\n0 0 0 0 0 1 0 0 0 1 0 0\n"
               "1 0 0 0 0 1 0 0 0 1 0 0\n0 1 0 0 0 1 0 0 0 1 0 0\n3 0 1 2 9\n"}};
  const test::TemporaryFolder folder;
  for (const test::Polygons& shape : {pyramids (), sheets ()})
  {
    for (const test::VtkFile file : test::vtkFiles ())
    {
      const std::string extension = test::extensionOf (file);
      const std::string path = folder.file ("seed" + extension);
      test::writeWithVtk (shape, file, path);
      seeds.push_back ({extension, test::readFile (path)});
    }
    const TriangleMesh mesh = loadMesh (folder.file ("seed.ply"));
    for (const std::string extension : {".ply", ".stl", ".obj"})
      for (const Eigen::Vector3d& origin : {Eigen::Vector3d (0, 0, 0), Eigen::Vector3d (512434, 5405590, 348)})
      {
        const std::string path = folder.file ("saved" + extension);
        saveMesh (mesh, path, origin);
        seeds.push_back ({extension, test::readFile (path)});
      }
  }
  return (seeds);
}

} // namespace fuzz
