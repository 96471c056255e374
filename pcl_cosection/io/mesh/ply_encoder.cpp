// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "ply_mesh.h"

#include <cstring>
#include <locale>
#include <sstream>
#include <type_traits>

namespace pcl::cosection {
namespace {

template <typename T>
void
put (std::string& bytes, const T& value)
{
  static_assert (std::is_trivially_copyable<T>::value, "only plain values have a file format");
  const std::size_t size = bytes.size ();
  bytes.resize (size + sizeof (T));
  std::memcpy (&bytes[size], &value, sizeof (T));
}

void
put (std::string& bytes, const Eigen::Vector3f& v)
{
  for (int axis = 0; axis < 3; ++axis)
    put (bytes, v[axis]);
}

} // namespace

std::string
encodePly (const TriangleMesh& mesh)
{
  std::ostringstream header;
  header.imbue (std::locale::classic ());
  header << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size ()
         << "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty ())
    header << "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colours.empty ())
    header << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!mesh.intensity.empty ())
    header << "property float intensity\n";
  if (!mesh.confidence.empty ())
    header << "property float confidence\n";
  if (!mesh.provenance.empty ())
    header << "property uchar provenance\n";
  header << "element face " << mesh.triangles.size () << "\nproperty list uchar int vertex_indices\nend_header\n";

  std::string bytes = header.str ();
  bytes.reserve (bytes.size () + mesh.vertices.size () * 32 + mesh.triangles.size () * 13);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    put (bytes, mesh.vertices[v]);
    if (!mesh.normals.empty ())
      put (bytes, mesh.normals[v]);
    if (!mesh.colours.empty ())
      put (bytes, mesh.colours[v]);
    if (!mesh.intensity.empty ())
      put (bytes, mesh.intensity[v]);
    if (!mesh.confidence.empty ())
      put (bytes, mesh.confidence[v]);
    if (!mesh.provenance.empty ())
      put (bytes, mesh.provenance[v]);
  }
  for (const auto& triangle : mesh.triangles)
  {
    put (bytes, std::uint8_t{3});
    put (bytes, triangle);
  }
  return bytes;
}

} // namespace pcl::cosection
