// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/clipped_mesh.h"

#include "pcl_cosection/common/plane_height.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pcl::cosection {

namespace {

constexpr double parallel_planes = 1e-9; // determinant of three unit normals

/** \brief Where the line between points on both sides of a plane meets it. */
Eigen::Vector3d
crossing (const Eigen::Vector3d& a, double height_a, const Eigen::Vector3d& b, double height_b)
{
  return a + height_a / (height_a - height_b) * (b - a);
}

std::vector<double>
heightsOver (const Eigen::Vector4d& plane, const MeshPiece& piece)
{
  std::vector<double> heights;
  heights.reserve (piece.vertices.size ());
  for (const Eigen::Vector3d& vertex : piece.vertices)
    heights.push_back (heightOver (plane, vertex));
  return heights;
}

/** \brief I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", CACM 1974. */
void
clip (std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector4d& plane)
{
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t n = 0; n < polygon.size (); ++n)
  {
    const Eigen::Vector3d &a = polygon[n], &b = polygon[(n + 1) % polygon.size ()];
    const double height_a = heightOver (plane, a), height_b = heightOver (plane, b);
    if (height_a <= 0.0)
      kept.push_back (a);
    if ((height_a <= 0.0) != (height_b <= 0.0))
      kept.push_back (crossing (a, height_a, b, height_b));
  }
  polygon = std::move (kept);
}

} // namespace

MeshPiece
pieceOf (const TriangleMesh& mesh)
{
  MeshPiece piece;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    piece.vertices.push_back (vertex.cast<double> ());
  piece.triangles = mesh.triangles;
  return piece;
}

MeshPiece
pieceBehind (const MeshPiece& piece, const Eigen::Vector4d& plane)
{
  const std::vector<double> heights = heightsOver (plane, piece);
  MeshPiece result;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers; // of a vertex, or of the crossing of an edge
  const auto vertex = [&] (std::uint64_t a, std::uint64_t b) {
    const auto [entry, is_new] = numbers.emplace (std::min (a, b) << 32 | std::max (a, b), result.vertices.size ());
    if (is_new)
      result.vertices.push_back (a == b ? piece.vertices[a]
                                        : crossing (piece.vertices[a], heights[a], piece.vertices[b], heights[b]));
    return entry->second;
  };
  for (const TriangleMesh::Triangle& triangle : piece.triangles)
  {
    std::vector<std::uint32_t> polygon;
    for (int n = 0; n < 3; ++n)
    {
      const std::uint32_t a = triangle[n], b = triangle[(n + 1) % 3];
      if (heights[a] <= 0.0)
        polygon.push_back (vertex (a, a));
      if ((heights[a] <= 0.0) != (heights[b] <= 0.0))
        polygon.push_back (vertex (a, b));
    }
    for (std::size_t n = 2; n < polygon.size (); ++n)
      result.triangles.push_back ({polygon[0], polygon[n - 1], polygon[n]});
  }
  return result;
}

std::vector<Eigen::Vector3d>
pointsBehind (const MeshPiece& piece, const Eigen::Vector4d& plane)
{
  const std::vector<double> heights = heightsOver (plane, piece);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t n = 0; n < heights.size (); ++n)
    if (heights[n] <= 0.0)
      points.push_back (piece.vertices[n]);
  for (const TriangleMesh::Triangle& triangle : piece.triangles)
    for (int n = 0; n < 3; ++n)
    {
      const std::uint32_t a = triangle[n], b = triangle[(n + 1) % 3];
      if (heights[a] <= 0.0 && heights[b] > 0.0) // its other triangle, if any, has it the other way round
        points.push_back (crossing (piece.vertices[a], heights[a], piece.vertices[b], heights[b]));
    }
  return points;
}

double
WindingNumber::operator() (const Eigen::Vector3d& point) const
{
  double angle = 0.0;
  for (const TriangleMesh::Triangle& triangle : mesh_.triangles)
  {
    const Eigen::Vector3d a = mesh_.vertices[triangle[0]].cast<double> () - point;
    const Eigen::Vector3d b = mesh_.vertices[triangle[1]].cast<double> () - point;
    const Eigen::Vector3d c = mesh_.vertices[triangle[2]].cast<double> () - point;
    const double x = a.norm (), y = b.norm (), z = c.norm ();
    angle += 2.0 * std::atan2 (a.dot (b.cross (c)), x * y * z + a.dot (b) * z + b.dot (c) * x + c.dot (a) * y);
  }
  return angle / (4.0 * M_PI);
}

std::vector<Eigen::Vector3d>
pointsBetween (const TriangleMesh& mesh, const std::vector<Eigen::Vector4d>& planes, const WindingNumber& winding)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> polygon;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
  {
    polygon.clear ();
    for (const std::uint32_t v : triangle)
      polygon.push_back (mesh.vertices[v].cast<double> ());
    for (std::size_t n = 0; n < planes.size () && !polygon.empty (); ++n)
    {
      int behind = 0;
      for (const Eigen::Vector3d& p : polygon)
        behind += heightOver (planes[n], p) <= 0.0 ? 1 : 0;
      if (behind == 0)
        polygon.clear ();
      else if (behind < static_cast<int> (polygon.size ()))
        clip (polygon, planes[n]);
    }
    points.insert (points.end (), polygon.begin (), polygon.end ());
  }
  for (std::size_t a = 0; a < planes.size (); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c)
      {
        Eigen::Matrix3d normals;
        normals << planes[a].head<3> ().transpose (), planes[b].head<3> ().transpose (),
            planes[c].head<3> ().transpose ();
        if (std::abs (normals.determinant ()) < parallel_planes)
          continue;
        const Eigen::Vector3d corner = -normals.inverse () * Eigen::Vector3d (planes[a][3], planes[b][3], planes[c][3]);
        const bool is_corner = std::all_of (planes.begin (), planes.end (), [&] (const Eigen::Vector4d& plane) {
          return (&plane == &planes[a] || &plane == &planes[b] || &plane == &planes[c] ||
                  heightOver (plane, corner) <= 0.0);
        });
        if (is_corner && winding (corner) > 0.5)
          points.push_back (corner);
      }
  return points;
}

} // namespace pcl::cosection
