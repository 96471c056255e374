// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "ply_mesh.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <sstream>

namespace pcl
{
namespace cosection
{
namespace
{

// ---- Header -------------------------------------------------------------------------------------

struct Property
{
  std::string name;
  std::string type;
  std::string count_type; ///< of lists; else empty
};

struct Element
{
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

/** \brief Bytes of a scalar type; 0 if there is none of this name. */
std::size_t
scalarSize (const std::string& type)
{
  if (type == "char" || type == "int8" || type == "uchar" || type == "uint8")
    return 1;
  if (type == "short" || type == "int16" || type == "ushort" || type == "uint16")
    return 2;
  if (type == "int" || type == "int32" || type == "uint" || type == "uint32" || type == "float" || type == "float32")
    return 4;
  if (type == "double" || type == "float64")
    return 8;
  return 0;
}

template <typename T>
double
load (const char* data)
{
  T value;
  std::memcpy (&value, data, sizeof (T));
  return static_cast<double> (value);
}

using Loader = double (*) (const char*);

Loader
scalarLoader (const std::string& type)
{
  if (type == "char" || type == "int8")
    return load<std::int8_t>;
  if (type == "uchar" || type == "uint8")
    return load<std::uint8_t>;
  if (type == "short" || type == "int16")
    return load<std::int16_t>;
  if (type == "ushort" || type == "uint16")
    return load<std::uint16_t>;
  if (type == "int" || type == "int32")
    return load<std::int32_t>;
  if (type == "uint" || type == "uint32")
    return load<std::uint32_t>;
  if (type == "float" || type == "float32")
    return load<float>;
  return load<double>;
}

Property
parseProperty (std::istringstream& words)
{
  Property property;
  words >> property.type;
  if (property.type == "list")
    words >> property.count_type >> property.type;
  words >> property.name;
  if (!words || scalarSize (property.type) == 0 ||
      (!property.count_type.empty () && scalarSize (property.count_type) == 0))
    throw IoError ("a property of the PLY header has an unknown type");
  return property;
}

/** \brief Reads the header and moves \a offset behind it. */
std::vector<Element>
parseHeader (const std::string& bytes, std::size_t& offset)
{
  std::vector<Element> elements;
  bool binary = false;
  for (int line_number = 0;; ++line_number)
  {
    const std::size_t end = bytes.find ('\n', offset);
    if (end == std::string::npos)
      throw IoError (line_number == 0 ? "not a PLY file" : "the PLY header does not end");
    std::istringstream words (bytes.substr (offset, end - offset));
    offset = end + 1;
    std::string keyword;
    words >> keyword;
    if (line_number == 0)
    {
      if (keyword != "ply")
        throw IoError ("not a PLY file");
      continue;
    }
    if (keyword == "end_header")
      break;
    if (keyword == "format")
    {
      std::string format;
      words >> format;
      binary = (format == "binary_little_endian");
      if (!binary)
        throw IoError ("PLY format '" + format + "' is not supported, only binary_little_endian");
    }
    else if (keyword == "element")
    {
      Element element;
      if (!(words >> element.name >> element.count))
        throw IoError ("an element of the PLY header has no count");
      elements.push_back (element);
    }
    else if (keyword == "property")
    {
      if (elements.empty ())
        throw IoError ("a property of the PLY header belongs to no element");
      elements.back ().properties.push_back (parseProperty (words));
    }
    else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty ())
      throw IoError ("unknown keyword in the PLY header");
  }
  if (!binary)
    throw IoError ("the PLY header names no format");
  return elements;
}

// ---- Data ---------------------------------------------------------------------------------------

/** \brief The data behind the header; every access is checked. */
class Reader
{
public:
  Reader (const std::string& bytes, std::size_t offset) : data_ (bytes.data () + offset), left_ (bytes.size () - offset)
  {}

  /** \brief The next \a count * \a size bytes. */
  const char*
  take (std::uint64_t count, std::size_t size)
  {
    if (size != 0 && count > left_ / size)
      throw IoError ("the PLY file is shorter than its header says");
    const char* data = data_;
    data_ += count * size;
    left_ -= count * size;
    return data;
  }

private:
  const char* data_;
  std::size_t left_;
};

/** \brief Where values of one vertex property go. */
using Setter = std::function<void (TriangleMesh&, std::size_t, double)>;

std::uint8_t
toByte (double value)
{
  return static_cast<std::uint8_t> (value >= 0.0 ? std::min (value, 255.0) : 0.0);
}

Setter
vertexSetter (const std::string& name)
{
  static constexpr std::array<const char*, 3> positions = {"x", "y", "z"};
  static constexpr std::array<const char*, 3> normals = {"nx", "ny", "nz"};
  static constexpr std::array<const char*, 3> colours = {"red", "green", "blue"};
  for (int axis = 0; axis < 3; ++axis)
  {
    if (name == positions[axis])
      return
          [axis] (TriangleMesh& m, std::size_t v, double value) { m.vertices[v][axis] = static_cast<float> (value); };
    if (name == normals[axis])
      return [axis] (TriangleMesh& m, std::size_t v, double value) { m.normals[v][axis] = static_cast<float> (value); };
    if (name == colours[axis])
      return [axis] (TriangleMesh& m, std::size_t v, double value) { m.colours[v][axis] = toByte (value); };
  }
  if (name == "intensity")
    return [] (TriangleMesh& m, std::size_t v, double value) { m.intensity[v] = static_cast<float> (value); };
  if (name == "confidence")
    return [] (TriangleMesh& m, std::size_t v, double value) { m.confidence[v] = static_cast<float> (value); };
  if (name == "provenance")
    return [] (TriangleMesh& m, std::size_t v, double value) { m.provenance[v] = toByte (value); };
  return {};
}

void
readVertices (const Element& element, Reader& reader, TriangleMesh& mesh)
{
  struct Column
  {
    Setter set;
    Loader load;
    std::size_t offset;
  };
  std::size_t stride = 0;
  std::vector<Column> columns;
  std::string names = " ";
  for (const Property& property : element.properties)
  {
    if (!property.count_type.empty ())
      throw IoError ("a vertex property is a list");
    if (const Setter set = vertexSetter (property.name))
      columns.push_back ({set, scalarLoader (property.type), stride});
    stride += scalarSize (property.type);
    names += property.name + " ";
  }
  const auto has = [&names] (const char* name) {
    return names.find (std::string (" ") + name + " ") != std::string::npos;
  };
  if (!has ("x") || !has ("y") || !has ("z"))
    throw IoError ("the vertices have no x, y and z");

  const char* data = reader.take (element.count, stride); // bounds the allocations below by the size of the file
  mesh.vertices.resize (element.count);
  if (has ("nx") || has ("ny") || has ("nz"))
    mesh.normals.resize (element.count, Eigen::Vector3f::Zero ());
  if (has ("red") || has ("green") || has ("blue"))
    mesh.colours.resize (element.count);
  if (has ("intensity"))
    mesh.intensity.resize (element.count);
  if (has ("confidence"))
    mesh.confidence.resize (element.count);
  if (has ("provenance"))
    mesh.provenance.resize (element.count);
  for (std::size_t v = 0; v < element.count; ++v, data += stride)
    for (const Column& column : columns)
      column.set (mesh, v, column.load (data + column.offset));
}

/** \brief A property of a face, ready to be read again and again. */
struct FaceColumn
{
  explicit FaceColumn (const Property& property)
      : is_list (!property.count_type.empty ())
      , is_corners (is_list && (property.name == "vertex_indices" || property.name == "vertex_index"))
      , size (scalarSize (property.type))
      , count_size (scalarSize (property.count_type))
      , load (scalarLoader (property.type))
      , load_count (scalarLoader (property.count_type))
  {}

  bool is_list;
  bool is_corners;
  std::size_t size;
  std::size_t count_size;
  Loader load;
  Loader load_count;
};

TriangleMesh::Triangle
readTriangle (const char* data, const FaceColumn& column, double vertex_count)
{
  TriangleMesh::Triangle triangle;
  for (int n = 0; n < 3; ++n)
  {
    const double index = column.load (data + n * column.size);
    if (!(index >= 0.0 && index < vertex_count))
      throw IoError ("a face refers to a vertex that does not exist");
    triangle[n] = static_cast<std::uint32_t> (index);
  }
  return triangle;
}

void
readFaces (const Element& element, Reader& reader, TriangleMesh& mesh)
{
  const std::vector<FaceColumn> columns (element.properties.begin (), element.properties.end ());
  if (std::none_of (columns.begin (), columns.end (), [] (const FaceColumn& column) { return column.is_corners; }))
    throw IoError ("the faces have no vertex_indices");
  const auto vertex_count = static_cast<double> (mesh.vertices.size ());
  for (std::uint64_t f = 0; f < element.count; ++f)
    for (const FaceColumn& column : columns)
    {
      if (!column.is_list)
      {
        reader.take (1, column.size);
        continue;
      }
      const double count = column.load_count (reader.take (1, column.count_size));
      if (!(count >= 0.0 && count <= std::numeric_limits<std::uint32_t>::max ()))
        throw IoError ("a face has an impossible number of corners");
      const char* data = reader.take (static_cast<std::uint64_t> (count), column.size);
      if (!column.is_corners)
        continue;
      if (count != 3.0)
        throw IoError ("a face is not a triangle");
      mesh.triangles.push_back (readTriangle (data, column, vertex_count));
    }
}

} // namespace

TriangleMesh
decodePly (const std::string& bytes)
{
  std::size_t offset = 0;
  const auto elements = parseHeader (bytes, offset);
  Reader reader (bytes, offset);
  TriangleMesh mesh;
  bool has_vertices = false;
  bool has_faces = false;
  for (const Element& element : elements)
  {
    if (element.name == "vertex" && !has_vertices)
    {
      readVertices (element, reader, mesh);
      has_vertices = true;
    }
    else if (element.name == "face" && has_vertices && !has_faces)
    {
      readFaces (element, reader, mesh);
      has_faces = true;
    }
    else if (!has_faces)
      throw IoError ("the PLY file does not begin with one list of vertices and one of faces");
  }
  if (!has_faces)
    throw IoError ("the PLY file has no faces");
  return mesh;
}

} // namespace cosection
} // namespace pcl
