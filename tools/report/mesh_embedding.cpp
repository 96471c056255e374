// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_embedding.h"

#include "data_uri.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace pcl::cosection;

namespace {

constexpr double steps = 65535.0; ///< along each side of the box

/** \brief Appends whole numbers, lowest byte first. */
class Bytes
{
public:
  explicit Bytes (std::size_t size) { bytes_.reserve (size); }

  void add (std::uint32_t value, int bytes)
  {
    for (int n = 0; n < bytes; ++n)
      bytes_.push_back (static_cast<std::uint8_t> (value >> (8 * n)));
  }

  std::string letters () const { return (toBase64 (bytes_.data (), bytes_.size ())); }

private:
  std::vector<std::uint8_t> bytes_;
};

void
check (const TriangleMesh& mesh, const std::vector<double>& errors_m)
{
  const std::size_t vertices = mesh.vertices.size ();
  for (const std::size_t size :
       {mesh.colours.size (), mesh.provenance.size (), mesh.confidence.size (), errors_m.size ()})
    if (size != 0 && size != vertices)
      throw std::invalid_argument ("a mesh to embed must have one value per vertex, or none");
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    if (*std::max_element (triangle.begin (), triangle.end ()) >= vertices)
      throw std::invalid_argument ("a mesh to embed has a triangle of a vertex that is not there");
}

/** \brief Shares in [0, 1] as bytes; what is no number is 1. */
template <typename Value>
std::string
asBytes (const std::vector<Value>& values, double one)
{
  Bytes bytes (values.size ());
  for (const Value value : values)
  {
    const double share = static_cast<double> (value) / one;
    bytes.add (
        static_cast<std::uint32_t> (std::lround (255.0 * (std::isfinite (share) ? std::clamp (share, 0.0, 1.0) : 1.0))),
        1);
  }
  return (bytes.letters ());
}

} // namespace

TriangleMesh
forDisplay (const TriangleMesh& mesh, std::size_t most_triangles)
{
  if (mesh.triangles.size () <= most_triangles)
    return (mesh);
  try
  {
    return (decimate (mesh, most_triangles));
  }
  catch (const InvalidArgument&) // not a manifold: written by something else
  {
    return (mesh);
  }
}

Json
embedMesh (const TriangleMesh& mesh, const std::vector<double>& errors_m, double error_max_m)
{
  check (mesh, errors_m);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  if (box.isEmpty ())
    box.extend (Eigen::Vector3d::Zero ());
  const Eigen::Vector3d size = box.sizes ().cwiseMax (std::numeric_limits<float>::min ());
  Bytes positions (6 * mesh.vertices.size ());
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis)
      positions.add (static_cast<std::uint32_t> (std::lround (steps * (vertex[axis] - box.min ()[axis]) / size[axis])),
                     2);
  const int index_bytes = mesh.vertices.size () <= 65536 ? 2 : 4;
  Bytes indices (3 * mesh.triangles.size () * static_cast<std::size_t> (index_bytes));
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle)
      indices.add (index, index_bytes);

  Json json;
  json["vertices"] = mesh.vertices.size ();
  json["triangles"] = mesh.triangles.size ();
  json["min"] = {box.min ().x (), box.min ().y (), box.min ().z ()};
  json["size"] = {size.x (), size.y (), size.z ()};
  json["positions"] = positions.letters ();
  json["index_bytes"] = index_bytes;
  json["indices"] = indices.letters ();
  if (!mesh.colours.empty ())
    json["colours"] = toBase64 (mesh.colours.data (), 3 * mesh.colours.size ());
  if (!mesh.provenance.empty ())
    json["provenance"] = toBase64 (mesh.provenance.data (), mesh.provenance.size ());
  if (!mesh.confidence.empty ())
    json["confidence"] = asBytes (mesh.confidence, 1.0);
  if (!errors_m.empty ())
    json["error"] = asBytes (errors_m, error_max_m);
  return (json);
}
