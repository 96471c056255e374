// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PLY files are read by hand, because vtkPLYReader drops properties that it does not know, such as the provenance, and
// takes as much memory as a header claims.

#include "mesh_decoders.h"
#include "ply_header.h"
#include "value_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <functional>

namespace pcl::cosection {
namespace {

/** \brief Puts the value of one property where that of vertex v belongs. */
using Setter = std::function<void (std::size_t v, double value)>;

std::uint8_t
toByte (double value)
{
  return static_cast<std::uint8_t> (value >= 0.0 ? std::min (value, 255.0) : 0.0);
}

/** \brief The properties of the vertices but their positions, and the faces with these. */
struct PlyContents
{
  TriangleMesh mesh;
  PolygonSoup faces;
};

/** \brief The setter of a property, for which it makes room in the mesh; empty if the name is not known. */
Setter
vertexSetter (const std::string& name, std::size_t count, PlyContents& contents)
{
  TriangleMesh& mesh = contents.mesh;
  const auto real = [count] (std::vector<float>& values) -> Setter {
    values.resize (count);
    return [&values] (std::size_t v, double value) { values[v] = static_cast<float> (value); };
  };
  const auto component = [count] (std::vector<Eigen::Vector3f>& values, int axis) -> Setter {
    values.resize (count, Eigen::Vector3f::Zero ());
    return [&values, axis] (std::size_t v, double value) { values[v][axis] = static_cast<float> (value); };
  };
  static constexpr std::array<const char*, 3> positions = {"x", "y", "z"};
  static constexpr std::array<const char*, 3> normals = {"nx", "ny", "nz"};
  static constexpr std::array<const char*, 3> colours = {"red", "green", "blue"};
  for (int axis = 0; axis < 3; ++axis)
  {
    if (name == positions[axis])
    {
      contents.faces.points.resize (count, Eigen::Vector3d::Zero ());
      return [&contents, axis] (std::size_t v, double value) { contents.faces.points[v][axis] = value; };
    }
    if (name == normals[axis])
      return component (mesh.normals, axis);
    if (name != colours[axis])
      continue;
    mesh.colours.resize (count);
    return [&mesh, axis] (std::size_t v, double value) { mesh.colours[v][axis] = toByte (value); };
  }
  if (name == "intensity")
    return real (mesh.intensity);
  if (name == "confidence")
    return real (mesh.confidence);
  if (name == "sigma_m")
    return real (mesh.sigma_m);
  if (name != "provenance")
    return {};
  mesh.provenance.resize (count);
  return [&mesh] (std::size_t v, double value) { mesh.provenance[v] = toByte (value); };
}

void
readVertices (const PlyElement& element, PlyElementReader& reader, PlyContents& contents)
{
  for (const char* name : {"x", "y", "z"})
    if (std::none_of (element.properties.begin (), element.properties.end (),
                      [name] (const PlyProperty& p) { return !p.count_type && p.name == name; }))
      throw IoError ("the vertices have no x, y and z");
  reader.require (element);
  std::vector<Setter> setters;
  for (const PlyProperty& property : element.properties)
    setters.push_back (property.count_type ? Setter () : vertexSetter (property.name, element.count, contents));
  reader.read (element, [&] (std::uint64_t v, std::size_t p, double value) {
    if (setters[p])
      setters[p](v, value);
  });
}

/** \brief Faces, or strips of triangles one behind the other with a negative number between them. */
void
readFaces (const PlyElement& element, bool strips, PlyElementReader& reader, PolygonSoup& faces)
{
  const auto isCorners = [] (const PlyProperty& property) {
    return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
  };
  if (std::none_of (element.properties.begin (), element.properties.end (), isCorners))
    throw IoError ("the faces have no vertex_indices");
  reader.require (element);
  std::vector<std::int64_t> corners;
  for (std::uint64_t f = 0; f < element.count; ++f)
    for (const PlyProperty& property : element.properties)
    {
      if (!isCorners (property))
      {
        reader.skip (property);
        continue;
      }
      corners.clear ();
      for (std::uint64_t left = reader.readCount (property); left > 0; --left)
      {
        corners.push_back (reader.nextIndex (property));
        if (strips && corners.back () < 0)
        {
          corners.pop_back ();
          faces.addStrip (corners);
          corners.clear ();
        }
      }
      if (strips)
        faces.addStrip (corners);
      else
        faces.addPolygon (corners);
    }
}

PlyContents
decode (const std::string& bytes)
{
  TextScanner scanner (bytes);
  const PlyHeader header = parsePlyHeader (scanner);
  const auto isFaces = [] (const PlyElement& element) { return element.name == "face" || element.name == "tristrips"; };
  const auto needed = std::count_if (header.elements.begin (), header.elements.end (), [&] (const PlyElement& element) {
    return element.name == "vertex" || isFaces (element);
  });
  PlyElementReader reader (scanner, header.encoding);
  PlyContents contents;
  bool has_vertices = false;
  bool has_faces = false;
  auto left = needed;
  for (const PlyElement& element : header.elements)
  {
    if (left == 0)
      break; // whatever follows
    const bool is_vertices = element.name == "vertex";
    left -= is_vertices || isFaces (element);
    if (is_vertices && !has_vertices)
      readVertices (element, reader, contents);
    else if (isFaces (element))
      readFaces (element, element.name == "tristrips", reader, contents.faces);
    else
      reader.read (element, [] (std::uint64_t, std::size_t, double) {});
    has_vertices = has_vertices || is_vertices;
    has_faces = has_faces || isFaces (element);
  }
  if (!has_vertices)
    throw IoError ("the PLY file has no vertices");
  if (!has_faces)
    throw IoError ("the PLY file has no faces");
  return contents;
}

} // namespace

TriangleMesh
decodePly (const std::string& bytes, const Eigen::Vector3d& origin)
{
  PlyContents contents = decode (bytes);
  TriangleMesh& mesh = contents.mesh;
  for (const Eigen::Vector3d& point : contents.faces.points)
    mesh.vertices.push_back ((point - origin).cast<float> ());
  const auto count = static_cast<std::int64_t> (mesh.vertices.size ());
  std::size_t begin = 0;
  for (const std::size_t end : contents.faces.ends)
  {
    if (end - begin != 3)
      throw IoError ("a face is not a triangle");
    TriangleMesh::Triangle triangle;
    for (int n = 0; n < 3; ++n)
    {
      const std::int64_t corner = contents.faces.corners[begin + n];
      if (corner < 0 || corner >= count)
        throw IoError ("a face refers to a vertex that does not exist");
      triangle[n] = static_cast<std::uint32_t> (corner);
    }
    mesh.triangles.push_back (triangle);
    begin = end;
  }
  return std::move (mesh);
}

PolygonSoup
decodePlyPolygons (const std::string& bytes)
{
  return decode (bytes).faces;
}

} // namespace pcl::cosection
