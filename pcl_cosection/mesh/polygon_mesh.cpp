// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/triangle_mesh.h>

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr std::uint32_t no_field = ~std::uint32_t (0);

std::uint32_t
addField (PCLPointCloud2& cloud, const char* name, std::uint8_t type, std::uint32_t bytes)
{
  PCLPointField field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = type;
  field.count = 1;
  cloud.fields.push_back (field);
  cloud.point_step += bytes;
  return field.offset;
}

} // namespace

void
toPolygonMesh (const TriangleMesh& mesh, pcl::PolygonMesh& output)
{
  PCLPointCloud2 cloud;
  cloud.header = output.cloud.header;
  const auto floats = [&] (std::initializer_list<const char*> names) {
    const std::uint32_t offset = cloud.point_step;
    for (const char* name : names)
      addField (cloud, name, PCLPointField::FLOAT32, sizeof (float));
    return offset;
  };
  const std::uint32_t position = floats ({"x", "y", "z"});
  const std::uint32_t normal = mesh.normals.empty () ? no_field : floats ({"normal_x", "normal_y", "normal_z"});
  const std::uint32_t colour = mesh.colours.empty () ? no_field : floats ({"rgb"});
  const std::uint32_t intensity = mesh.intensity.empty () ? no_field : floats ({"intensity"});
  const std::uint32_t confidence = mesh.confidence.empty () ? no_field : floats ({"confidence"});
  const std::uint32_t provenance = mesh.provenance.empty ()
                                       ? no_field
                                       : addField (cloud, "provenance", PCLPointField::UINT8, sizeof (std::uint8_t));

  if (mesh.vertices.size () > std::numeric_limits<std::uint32_t>::max () / cloud.point_step)
    throw InvalidArgument ("the mesh has too many vertices for a pcl::PolygonMesh: " +
                           std::to_string (mesh.vertices.size ()));
  cloud.width = static_cast<std::uint32_t> (mesh.vertices.size ());
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_dense = true;
  cloud.data.resize (cloud.row_step);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    std::uint8_t* at = cloud.data.data () + v * cloud.point_step;
    std::memcpy (at + position, mesh.vertices[v].data (), 3 * sizeof (float));
    if (normal != no_field)
      std::memcpy (at + normal, mesh.normals[v].data (), 3 * sizeof (float));
    if (colour != no_field)
    {
      const auto& c = mesh.colours[v];
      const std::uint32_t packed = std::uint32_t (c[0]) << 16 | std::uint32_t (c[1]) << 8 | c[2];
      std::memcpy (at + colour, &packed, sizeof (packed));
    }
    if (intensity != no_field)
      std::memcpy (at + intensity, &mesh.intensity[v], sizeof (float));
    if (confidence != no_field)
      std::memcpy (at + confidence, &mesh.confidence[v], sizeof (float));
    if (provenance != no_field)
      at[provenance] = mesh.provenance[v];
  }
  output.cloud = std::move (cloud);
  output.polygons.resize (mesh.triangles.size ());
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
    output.polygons[t].vertices.assign (mesh.triangles[t].begin (), mesh.triangles[t].end ());
}

TriangleMesh
fromPolygonMesh (const pcl::PolygonMesh& mesh)
{
  const PCLPointCloud2& cloud = mesh.cloud;
  const std::size_t count = static_cast<std::size_t> (cloud.width) * cloud.height;
  std::array<std::size_t, 3> offsets{};
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string name (1, static_cast<char> ('x' + axis));
    const auto field = std::find_if (cloud.fields.begin (), cloud.fields.end (),
                                     [&] (const PCLPointField& f) { return f.name == name; });
    if (field == cloud.fields.end () || field->datatype != PCLPointField::FLOAT32 ||
        field->offset + sizeof (float) > cloud.point_step)
      throw InvalidArgument ("the mesh has no field " + name + " of floats");
    offsets[axis] = field->offset;
  }
  if (cloud.point_step == 0 || count > cloud.data.size () / cloud.point_step)
    throw InvalidArgument ("the mesh has fewer vertices than it says");
  TriangleMesh result;
  result.vertices.resize (count);
  for (std::size_t v = 0; v < count; ++v)
    for (int axis = 0; axis < 3; ++axis)
      std::memcpy (&result.vertices[v][axis], cloud.data.data () + v * cloud.point_step + offsets[axis],
                   sizeof (float));
  for (const pcl::Vertices& polygon : mesh.polygons)
  {
    if (polygon.vertices.size () < 3)
      throw InvalidArgument ("a polygon of the mesh has fewer than three vertices");
    for (const auto v : polygon.vertices)
      if (static_cast<std::size_t> (v) >= count)
        throw InvalidArgument ("a polygon of the mesh has a vertex " + std::to_string (v) + "; there are " +
                               std::to_string (count));
    for (std::size_t n = 2; n < polygon.vertices.size (); ++n)
      result.triangles.push_back ({static_cast<std::uint32_t> (polygon.vertices[0]),
                                   static_cast<std::uint32_t> (polygon.vertices[n - 1]),
                                   static_cast<std::uint32_t> (polygon.vertices[n])});
  }
  return result;
}

} // namespace pcl::cosection
