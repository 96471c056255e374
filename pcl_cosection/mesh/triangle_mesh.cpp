// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/triangle_mesh.h>

#include "mesh_checks.h"
#include "mesh_sides.h"
#include "pcl_cosection/common/disjoint_sets.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr std::uint32_t dropped = std::numeric_limits<std::uint32_t>::max ();

template <typename T>
std::vector<T>
select (const std::vector<T>& values, const std::vector<std::uint32_t>& indices)
{
  std::vector<T> selected (values.empty () ? 0 : indices.size ());
  for (std::size_t n = 0; n < selected.size (); ++n)
    selected[n] = values[indices[n]];
  return selected;
}

/** \brief Append the values of \a other's vertices, if both meshes have such values. */
template <typename T>
void
appendProperty (std::vector<T>& values, std::size_t vertices, const std::vector<T>& other, std::size_t other_vertices)
{
  if (values.size () != vertices || other.size () != other_vertices)
    values.clear ();
  else
    values.insert (values.end (), other.begin (), other.end ());
}

DisjointSets
connectedVertices (const TriangleMesh& mesh)
{
  DisjointSets sets (mesh.vertices.size ());
  for (const auto& triangle : mesh.triangles)
  {
    sets.unite (triangle[0], triangle[1]);
    sets.unite (triangle[0], triangle[2]);
  }
  return sets;
}

} // namespace

MeshTopology
computeTopology (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  MeshTopology topology;
  DisjointSets fans (3 * mesh.triangles.size ());
  const auto sides = sortedSides (mesh);
  int edges = 0;
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    for (std::size_t side = begin + 1; side < end; ++side)
      uniteFans (mesh, sides[begin], sides[side], fans);
    ++edges;
    const bool degenerate = (sides[begin].edge >> 32) == (sides[begin].edge & 0xffffffffu);
    if (degenerate || (end - begin > 1 && !isManifoldEdge (sides, begin, end)))
      ++topology.non_manifold_edges;
    else if (end - begin == 1)
      ++topology.boundary_edges;
  });

  std::vector<int> fans_of_vertex (mesh.vertices.size (), 0);
  for (std::size_t corner = 0; corner < 3 * mesh.triangles.size (); ++corner)
    if (fans.find (corner) == corner)
      ++fans_of_vertex[mesh.triangles[corner / 3][corner % 3]];
  int referenced = 0;
  DisjointSets connected = connectedVertices (mesh);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    if (fans_of_vertex[v] == 0)
      continue;
    ++referenced;
    topology.non_manifold_vertices += (fans_of_vertex[v] > 1);
    topology.components += (connected.find (v) == v);
  }
  topology.euler = referenced - edges + static_cast<int> (mesh.triangles.size ());
  topology.closed_manifold = !mesh.empty () && topology.boundary_edges == 0 && topology.non_manifold_edges == 0 &&
                             topology.non_manifold_vertices == 0;
  return topology;
}

std::vector<int>
labelComponents (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  return connectedVertices (mesh).numbers ();
}

MassProperties
computeMassProperties (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  MassProperties result;
  if (mesh.empty ())
    return result;
  // The signed tetrahedra between each triangle and one point near the mesh add up to its inside.
  const Eigen::Vector3d apex = mesh.vertices[mesh.triangles[0][0]].cast<double> ();
  Eigen::Vector3d first = Eigen::Vector3d::Zero ();  // integral of x
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero (); // integral of x x^T
  for (const auto& triangle : mesh.triangles)
  {
    Eigen::Matrix3d corners;
    for (int n = 0; n < 3; ++n)
      corners.col (n) = mesh.vertices[triangle[n]].cast<double> () - apex;
    const double determinant = corners.determinant ();
    const Eigen::Vector3d sum = corners.rowwise ().sum ();
    result.volume_m3 += determinant / 6.0;
    first += determinant / 24.0 * sum;
    second += determinant / 120.0 * (corners * corners.transpose () + sum * sum.transpose ());
  }
  if (result.volume_m3 == 0.0)
    return result;
  const Eigen::Vector3d centroid = first / result.volume_m3;
  const Eigen::Matrix3d covariance = second - result.volume_m3 * centroid * centroid.transpose ();
  result.centroid_m = apex + centroid;
  result.inertia = covariance.trace () * Eigen::Matrix3d::Identity () - covariance;
  return result;
}

TriangleMesh
extractTriangles (const TriangleMesh& mesh, const std::vector<bool>& keep)
{
  checkMesh (mesh);
  if (keep.size () != mesh.triangles.size ())
    throw InvalidArgument ("extractTriangles: there must be one flag per triangle");
  std::vector<std::uint32_t> new_index (mesh.vertices.size (), dropped);
  for (std::size_t t = 0; t < keep.size (); ++t)
    if (keep[t])
      for (const auto v : mesh.triangles[t])
        new_index[v] = 0;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < new_index.size (); ++v)
    if (new_index[v] != dropped)
    {
      new_index[v] = static_cast<std::uint32_t> (kept.size ());
      kept.push_back (v);
    }

  TriangleMesh result;
  result.vertices = select (mesh.vertices, kept);
  result.normals = select (mesh.normals, kept);
  result.colours = select (mesh.colours, kept);
  result.intensity = select (mesh.intensity, kept);
  result.confidence = select (mesh.confidence, kept);
  result.sigma_m = select (mesh.sigma_m, kept);
  result.provenance = select (mesh.provenance, kept);
  for (std::size_t t = 0; t < keep.size (); ++t)
    if (keep[t])
    {
      const auto& triangle = mesh.triangles[t];
      result.triangles.push_back ({new_index[triangle[0]], new_index[triangle[1]], new_index[triangle[2]]});
    }
  return result;
}

void
appendMesh (TriangleMesh& mesh, const TriangleMesh& other)
{
  if (&other == &mesh)
  {
    const TriangleMesh copy = other;
    return appendMesh (mesh, copy);
  }
  checkMesh (mesh);
  checkMesh (other);
  const std::size_t offset = mesh.vertices.size ();
  const std::size_t added = other.vertices.size ();
  if (offset + added >= dropped)
    throw InvalidArgument ("appendMesh: the union has more vertices than a 32-bit index can count");
  appendProperty (mesh.normals, offset, other.normals, added);
  appendProperty (mesh.colours, offset, other.colours, added);
  appendProperty (mesh.intensity, offset, other.intensity, added);
  appendProperty (mesh.confidence, offset, other.confidence, added);
  appendProperty (mesh.sigma_m, offset, other.sigma_m, added);
  appendProperty (mesh.provenance, offset, other.provenance, added);
  mesh.vertices.insert (mesh.vertices.end (), other.vertices.begin (), other.vertices.end ());
  mesh.triangles.reserve (mesh.triangles.size () + other.triangles.size ());
  const auto shift = static_cast<std::uint32_t> (offset);
  for (const auto& triangle : other.triangles)
    mesh.triangles.push_back ({triangle[0] + shift, triangle[1] + shift, triangle[2] + shift});
}

void
toPolygonMesh (const TriangleMesh& mesh, pcl::PolygonMesh& output)
{
  PCLPointCloud2 cloud;
  cloud.header = output.cloud.header;
  std::vector<std::pair<const void*, std::size_t>> columns; // values of the vertices, and the bytes of each
  const auto add = [&] (const auto& values, std::initializer_list<const char*> names,
                        std::uint8_t type = PCLPointField::FLOAT32) {
    for (const char* name : names)
    {
      PCLPointField field;
      field.name = name;
      field.offset = cloud.point_step;
      field.datatype = type;
      field.count = 1;
      cloud.fields.push_back (field);
      cloud.point_step += static_cast<std::uint32_t> (sizeof (values[0]) / names.size ());
    }
    columns.emplace_back (values.data (), sizeof (values[0]));
  };
  add (mesh.vertices, {"x", "y", "z"});
  if (!mesh.normals.empty ())
    add (mesh.normals, {"normal_x", "normal_y", "normal_z"});
  std::vector<std::uint32_t> packed_colours;
  for (const auto& c : mesh.colours)
    packed_colours.push_back (std::uint32_t (c[0]) << 16 | std::uint32_t (c[1]) << 8 | c[2]);
  if (!packed_colours.empty ())
    add (packed_colours, {"rgb"});
  if (!mesh.intensity.empty ())
    add (mesh.intensity, {"intensity"});
  if (!mesh.confidence.empty ())
    add (mesh.confidence, {"confidence"});
  if (!mesh.sigma_m.empty ())
    add (mesh.sigma_m, {"sigma_m"});
  if (!mesh.provenance.empty ())
    add (mesh.provenance, {"provenance"}, PCLPointField::UINT8);

  if (mesh.vertices.size () > std::numeric_limits<std::uint32_t>::max () / cloud.point_step)
    throw InvalidArgument ("the mesh has too many vertices for a pcl::PolygonMesh: " +
                           std::to_string (mesh.vertices.size ()));
  cloud.width = static_cast<std::uint32_t> (mesh.vertices.size ());
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_dense = true;
  cloud.data.resize (cloud.row_step);
  std::uint8_t* out = cloud.data.data ();
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    for (const auto& [values, bytes] : columns)
      out = std::copy_n (static_cast<const std::uint8_t*> (values) + v * bytes, bytes, out);
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
