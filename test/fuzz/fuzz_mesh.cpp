// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// Bytes as a file of a mesh.

#include "fuzz_target.h"
#include "memory_file.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <cstring>

using namespace pcl::cosection;

namespace
{

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
                             "float confidence", "uchar provenance", "int unknown"})
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
      bytes.append (3 * sizeof (float) + 3 + sizeof (float) + 1 + sizeof (int), '\1');
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

void
check (const TriangleMesh& mesh)
{
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    fuzz::require (*std::max_element (triangle.begin (), triangle.end ()) < mesh.vertices.size (),
                   "triangles are of vertices that there are");
  for (const std::size_t size :
       {mesh.normals.size (), mesh.colours.size (), mesh.confidence.size (), mesh.provenance.size ()})
    fuzz::require (size == 0 || size == mesh.vertices.size (), "a property has a value for every vertex");
  computeTopology (mesh);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {tetrahedron<float, std::int32_t> ("float", "int", "vertex_indices", false),
          tetrahedron<double, std::uint8_t> ("double", "uchar", "vertex_index", false),
          tetrahedron<float, std::uint16_t> ("float32", "uint16", "vertex_indices", true)};
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"ply",      "format",  "binary_little_endian", "ascii", "1.0",   "element", "vertex",     "face",
          "property", "list",    "char",                 "uchar", "short", "ushort",  "int",        "uint",
          "float",    "double",  "int8",                 "uint8", "x",     "y",       "z",          "nx",
          "red",      "comment", "obj_info",             "vertex_indices", "confidence", "provenance", "end_header"};
}

bool
fuzz::accepts (const std::string& input)
{
  static MemoryFile file;
  file.set (input);
  TriangleMesh mesh;
  try
  {
    mesh = loadPlyMesh (file.path ());
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  check (mesh);
  return (true);
}
