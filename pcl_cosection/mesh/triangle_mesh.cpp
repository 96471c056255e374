// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_checks.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <limits>

namespace pcl::cosection {
namespace {

constexpr std::uint32_t dropped = std::numeric_limits<std::uint32_t>::max ();

template <typename T>
std::vector<T>
select (const std::vector<T>& values, const std::vector<std::uint32_t>& indices)
{
  std::vector<T> selected;
  if (values.empty ())
    return selected;
  selected.reserve (indices.size ());
  for (const auto index : indices)
    selected.push_back (values[index]);
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

} // namespace

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
  appendProperty (mesh.provenance, offset, other.provenance, added);
  mesh.vertices.insert (mesh.vertices.end (), other.vertices.begin (), other.vertices.end ());
  mesh.triangles.reserve (mesh.triangles.size () + other.triangles.size ());
  const auto shift = static_cast<std::uint32_t> (offset);
  for (const auto& triangle : other.triangles)
    mesh.triangles.push_back ({triangle[0] + shift, triangle[1] + shift, triangle[2] + shift});
}

} // namespace pcl::cosection
