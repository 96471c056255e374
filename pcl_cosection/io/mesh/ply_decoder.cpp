// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PLY files are read by hand, because vtkPLYReader drops properties that it does not know, such as the provenance, and
// takes as much memory as a header claims.

#include "mesh_decoders.h"
#include "value_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <sstream>

namespace pcl::cosection {
namespace {

struct PlyProperty
{
  std::string name;
  ScalarType type = ScalarType::Float32;
  std::optional<ScalarType> count_type; ///< of lists
};

struct PlyElement
{
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader
{
  Encoding encoding = Encoding::Ascii;
  std::vector<PlyElement> elements;
};

ScalarType
scalarType (const std::string& name)
{
  static constexpr std::pair<const char*, ScalarType> names[] = {
      {"char", ScalarType::Int8},      {"int8", ScalarType::Int8},       {"uchar", ScalarType::UInt8},
      {"uint8", ScalarType::UInt8},    {"short", ScalarType::Int16},     {"int16", ScalarType::Int16},
      {"ushort", ScalarType::UInt16},  {"uint16", ScalarType::UInt16},   {"int", ScalarType::Int32},
      {"int32", ScalarType::Int32},    {"uint", ScalarType::UInt32},     {"uint32", ScalarType::UInt32},
      {"float", ScalarType::Float32},  {"float32", ScalarType::Float32}, {"double", ScalarType::Float64},
      {"float64", ScalarType::Float64}};
  for (const auto& [known, type] : names)
    if (name == known)
      return type;
  throw IoError ("a property of the PLY header has an unknown type");
}

Encoding
encodingOf (const std::string& format)
{
  if (format == "ascii")
    return Encoding::Ascii;
  if (format == "binary_little_endian")
    return Encoding::LittleEndian;
  if (format == "binary_big_endian")
    return Encoding::BigEndian;
  throw IoError ("PLY format " + quoted (format) +
                 " is not supported, only ascii, binary_little_endian and binary_big_endian");
}

PlyProperty
parseProperty (std::istringstream& words)
{
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list")
  {
    words >> type;
    property.count_type = scalarType (type);
    type.clear ();
    words >> type;
  }
  property.type = scalarType (type);
  if (!(words >> property.name))
    throw IoError ("a property of the PLY header has no name");
  return property;
}

/** \brief Reads the header; \a scanner is behind it then. */
PlyHeader
parsePlyHeader (TextScanner& scanner)
{
  PlyHeader header;
  bool has_format = false;
  for (int line_number = 0;; ++line_number)
  {
    if (scanner.left ().find ('\n') == std::string_view::npos)
      throw IoError (line_number == 0 ? "not a PLY file" : "the PLY header does not end");
    std::istringstream words{std::string (scanner.line ())};
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
      header.encoding = encodingOf (format);
      has_format = true;
    }
    else if (keyword == "element")
    {
      PlyElement element;
      if (!(words >> element.name >> element.count))
        throw IoError ("an element of the PLY header has no count");
      header.elements.push_back (element);
    }
    else if (keyword == "property")
    {
      if (header.elements.empty ())
        throw IoError ("a property of the PLY header belongs to no element");
      header.elements.back ().properties.push_back (parseProperty (words));
    }
    else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty ())
      throw IoError ("unknown keyword in the PLY header");
  }
  if (!has_format)
    throw IoError ("the PLY header names no format");
  return header;
}

/** \brief Puts the value of one property where that of vertex v belongs. */
using Setter = std::function<void (std::size_t v, double value)>;

std::uint8_t
toByte (double value)
{
  return static_cast<std::uint8_t> (value >= 0.0 ? std::min (value, 255.0) : 0.0);
}

/** \brief The setter of a property, for which it makes room in the mesh; empty if the name is not known. */
Setter
vertexSetter (const std::string& name, std::size_t count, TriangleMesh& mesh)
{
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
      return component (mesh.vertices, axis);
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

/** \brief The vertices, with their properties, and the faces as they are. */
struct PlyContents
{
  TriangleMesh mesh;
  PolygonSoup faces;
};

/** \brief Reads the elements of a file one after the other. */
class PlyReader
{
public:
  PlyReader (TextScanner& scanner, Encoding encoding) : values_ (scanner, encoding, "PLY") {}

  void readVertices (const PlyElement& element, TriangleMesh& mesh)
  {
    for (const char* name : {"x", "y", "z"})
      if (std::none_of (element.properties.begin (), element.properties.end (),
                        [name] (const PlyProperty& p) { return !p.count_type && p.name == name; }))
        throw IoError ("the vertices have no x, y and z");
    require (element);
    std::vector<Setter> setters;
    for (const PlyProperty& property : element.properties)
      setters.push_back (property.count_type ? Setter () : vertexSetter (property.name, element.count, mesh));
    for (std::size_t v = 0; v < element.count; ++v)
      for (std::size_t p = 0; p < setters.size (); ++p)
      {
        if (element.properties[p].count_type)
          skip (element.properties[p]);
        else if (const double value = values_.next (element.properties[p].type); setters[p])
          setters[p](v, value);
      }
  }

  /** \brief Faces, or strips of triangles one behind the other with a negative number between them. */
  void readFaces (const PlyElement& element, bool strips, PolygonSoup& faces)
  {
    const auto isCorners = [] (const PlyProperty& property) {
      return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    if (std::none_of (element.properties.begin (), element.properties.end (), isCorners))
      throw IoError ("the faces have no vertex_indices");
    require (element);
    std::vector<std::int64_t> corners;
    for (std::uint64_t f = 0; f < element.count; ++f)
      for (const PlyProperty& property : element.properties)
      {
        if (!isCorners (property))
        {
          skip (property);
          continue;
        }
        corners.clear ();
        for (std::uint64_t left = readCount (property); left > 0; --left)
        {
          corners.push_back (values_.nextIndex (property.type));
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

  void skipElement (const PlyElement& element)
  {
    require (element);
    for (std::uint64_t n = 0; n < element.count && !element.properties.empty (); ++n)
      for (const PlyProperty& property : element.properties)
        skip (property);
  }

private:
  /** \brief Bounds what is allocated, and how long it takes, by the size of the file. */
  void require (const PlyElement& element) const
  {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += sizeOf (property.count_type.value_or (property.type));
    values_.require (element.count, bytes, element.properties.size ());
  }

  std::uint64_t readCount (const PlyProperty& property)
  {
    const std::int64_t count = values_.nextIndex (*property.count_type);
    if (count < 0)
      throw IoError ("a face has an impossible number of corners");
    values_.require (static_cast<std::uint64_t> (count), sizeOf (property.type), 1);
    return static_cast<std::uint64_t> (count);
  }

  void skip (const PlyProperty& property)
  {
    for (std::uint64_t left = (property.count_type ? readCount (property) : 1); left > 0; --left)
      values_.next (property.type);
  }

  ValueReader values_;
};

PlyContents
decode (const std::string& bytes)
{
  TextScanner scanner (bytes);
  const PlyHeader header = parsePlyHeader (scanner);
  const auto isFaces = [] (const PlyElement& element) { return element.name == "face" || element.name == "tristrips"; };
  const auto needed = std::count_if (header.elements.begin (), header.elements.end (), [&] (const PlyElement& element) {
    return element.name == "vertex" || isFaces (element);
  });
  PlyReader reader (scanner, header.encoding);
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
      reader.readVertices (element, contents.mesh);
    else if (isFaces (element))
      reader.readFaces (element, element.name == "tristrips", contents.faces);
    else
      reader.skipElement (element);
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
decodePly (const std::string& bytes)
{
  PlyContents contents = decode (bytes);
  TriangleMesh& mesh = contents.mesh;
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
  PlyContents contents = decode (bytes);
  contents.faces.points = std::move (contents.mesh.vertices);
  return std::move (contents.faces);
}

} // namespace pcl::cosection
