// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a file of a mesh: the first line is the extension of its name, the file follows.

#include "fuzz_target.h"
#include "memory_file.h"
#include "seeds/mesh_seeds.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <array>

using namespace pcl::cosection;

namespace {

const std::array<std::string, 6> extensions = {".ply", ".stl", ".obj", ".off", ".vtk", ".vtp"};

void
check (const TriangleMesh& mesh)
{
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    fuzz::require (*std::max_element (triangle.begin (), triangle.end ()) < mesh.vertices.size (),
                   "triangles are of vertices that there are");
  for (const std::size_t size : {mesh.normals.size (), mesh.colours.size (), mesh.confidence.size (),
                                 mesh.sigma_m.size (), mesh.provenance.size ()})
    fuzz::require (size == 0 || size == mesh.vertices.size (), "a property has a value for every vertex");
  computeTopology (mesh);
}

/** \brief What loadMesh () promises beyond that. */
void
checkReady (const TriangleMesh& mesh)
{
  check (mesh);
  fuzz::require (!mesh.empty (), "a mesh has triangles");
  std::vector<bool> used (mesh.vertices.size (), false);
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    fuzz::require (t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "triangles have three corners");
    for (const auto v : t)
      used[v] = true;
  }
  fuzz::require (std::find (used.begin (), used.end (), false) == used.end (), "vertices are of triangles");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    fuzz::require (vertex.allFinite (), "vertices are finite");
}

/** \brief Calls \a load and \a check. \param[in] near whether coordinates are relative to an origin near the mesh
 * \return whether the file was accepted */
template <typename Load, typename Check>
bool
loads (const Load& load, const std::string& path, const Check& check, bool near)
{
  TriangleMesh mesh;
  try
  {
    const Eigen::Vector3d origin = near ? localOrigin (path) : Eigen::Vector3d (0.0, 0.0, 0.0);
    fuzz::require (origin.allFinite (), "the origin is finite");
    mesh = load (path, origin);
  }
  catch (const Error& error)
  {
    fuzz::requireMessage (error.what ());
    return (false);
  }
  check (mesh);
  return (true);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  std::vector<std::string> result;
  for (const MeshSeed& seed : meshSeeds ())
    result.push_back (seed.extension + "\n" + seed.bytes);
  return (result);
}

std::vector<std::string>
fuzz::dictionary ()
{
  std::vector<std::string> words (extensions.begin (), extensions.end ());
  for (const char* word : {"ply",
                           "format",
                           "binary_little_endian",
                           "binary_big_endian",
                           "ascii",
                           "1.0",
                           "element",
                           "vertex",
                           "face",
                           "tristrips",
                           "property",
                           "list",
                           "char",
                           "uchar",
                           "short",
                           "ushort",
                           "int",
                           "uint",
                           "float",
                           "double",
                           "int8",
                           "x",
                           "nx",
                           "red",
                           "comment",
                           "obj_info",
                           "vertex_indices",
                           "confidence",
                           "sigma_m",
                           "provenance",
                           "end_header", // PLY
                           "solid",
                           "facet",
                           "outer",
                           "loop",
                           "endloop",
                           "endfacet",
                           "endsolid", // STL
                           "v",
                           "vn",
                           "f",
                           "fo",
                           "l",
                           "\\\n",
                           "#",
                           "1/2/3",
                           "-1//-1",
                           "OFF",
                           "COFF",
                           "nOFF",
                           "BINARY", // OBJ, OFF
                           "# vtk DataFile Version 5.1",
                           "ASCII",
                           "DATASET",
                           "POLYDATA",
                           "POINTS",
                           "POLYGONS",
                           "TRIANGLE_STRIPS",
                           "LINES",
                           "VERTICES",
                           "OFFSETS",
                           "CONNECTIVITY",
                           "vtktypeint64",
                           "FIELD",
                           "METADATA",
                           "POINT_DATA",
                           "CELL_DATA", // VTK
                           "<?xml",
                           "<VTKFile",
                           "<Piece",
                           "</Piece>",
                           "<Polys>",
                           "</Polys>",
                           "<Strips>",
                           "<DataArray",
                           "</DataArray>",
                           "/>",
                           "type",
                           "Int64",
                           "UInt8",
                           "Float64",
                           "String",
                           "NumberOfPoints",
                           "NumberOfPolys",
                           "NumberOfComponents",
                           "NumberOfTuples",
                           "Name",
                           "offset",
                           "offsets",
                           "connectivity",
                           "appended",
                           "binary",
                           "header_type",
                           "UInt64",
                           "byte_order",
                           "BigEndian",
                           "compressor",
                           "vtkZLibDataCompressor",
                           "vtkLZ4DataCompressor",
                           "<AppendedData",
                           "encoding",
                           "raw",
                           "base64",
                           "\"",
                           "_"})
    words.push_back (word);
  return (words);
}

bool
fuzz::accepts (const std::string& input)
{
  static NamedMemoryFile file;
  const std::size_t end = std::min (input.find ('\n'), input.size ());
  file.set (input.substr (std::min (end + 1, input.size ())));
  const bool near = input.size () % 2 == 1; // any choice that the same input makes again
  const auto extension = std::find (extensions.begin (), extensions.end (), input.substr (0, end));
  if (extension == extensions.end ()) // what the file begins with decides
    return (loads (loadMesh, file.path (".any"), checkReady, near));
  if (*extension == ".ply")
    loads (loadPlyMesh, file.path (*extension), check, near);
  return (loads (loadMesh, file.path (*extension), checkReady, near));
}
