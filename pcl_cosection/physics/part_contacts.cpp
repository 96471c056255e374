// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/part_contacts.h"

#include "pcl_cosection/physics/clipped_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace pcl::cosection {

namespace {

constexpr double least_turn = 1e-6; // sine of the angle between two faces, or two edges, that are not parallel

struct Extent
{
  double low = std::numeric_limits<double>::infinity (), high = -low;
};

Extent
extentAlong (const Eigen::Vector3d& direction, const ConvexHull& hull)
{
  Extent extent;
  for (const Eigen::Vector3d& corner : hull.corners)
  {
    const double place = direction.dot (corner);
    extent.low = std::min (extent.low, place);
    extent.high = std::max (extent.high, place);
  }
  return extent;
}

Separation
along (const Eigen::Vector3d& direction, const ConvexHull& first, const ConvexHull& second)
{
  const double high = extentAlong (direction, first).high, low = extentAlong (direction, second).low;
  return {high - low, direction, 0.5 * (high + low)};
}

/** \brief An edge between two faces that are not in one plane. */
struct Edge
{
  Eigen::Vector3d end, direction;         ///< unit
  std::array<Eigen::Vector3d, 2> normals; ///< of its faces
  Eigen::Vector3d across;                 ///< their cross product
};

std::vector<Edge>
edgesOf (const ConvexHull& hull)
{
  std::vector<std::array<std::uint32_t, 3>> sides; // both ends, and the face
  for (std::size_t face = 0; face < hull.triangles.size (); ++face)
    for (int n = 0; n < 3; ++n)
    {
      const std::uint32_t a = hull.triangles[face][n], b = hull.triangles[face][(n + 1) % 3];
      sides.push_back ({std::min (a, b), std::max (a, b), static_cast<std::uint32_t> (face)});
    }
  std::sort (sides.begin (), sides.end ());
  std::vector<Edge> edges;
  for (std::size_t n = 0; n + 1 < sides.size (); ++n)
  {
    const auto &one = sides[n], &other = sides[n + 1];
    if (one[0] != other[0] || one[1] != other[1])
      continue;
    const Eigen::Vector3d a = hull.planes[one[2]].head<3> (), b = hull.planes[other[2]].head<3> ();
    if (const Eigen::Vector3d across = a.cross (b); across.norm () > least_turn)
      edges.push_back (
          {hull.corners[one[0]], (hull.corners[one[1]] - hull.corners[one[0]]).normalized (), {a, b}, across});
  }
  return edges;
}

/** \brief Whether two edges are the sides of a face of the Minkowski difference: the arcs of their normals cross on the
 * unit sphere (D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013). */
bool
makeFace (const Edge& first, const Edge& second)
{
  const double a = -second.normals[0].dot (first.across), b = -second.normals[1].dot (first.across);
  const double c = first.normals[0].dot (second.across), d = first.normals[1].dot (second.across);
  return a * b < 0.0 && c * d < 0.0 && a * d > 0.0;
}

} // namespace

Separation
separationOf (const ConvexHull& first, const ConvexHull& second)
{
  Separation best;
  best.depth_m = std::numeric_limits<double>::infinity ();
  const auto tryAlong = [&] (const Eigen::Vector3d& direction) {
    const Separation found = along (direction, first, second);
    if (found.depth_m < best.depth_m)
      best = found;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      tryAlong (sign * Eigen::Vector3d::Unit (axis));
  if (best.depth_m < 0.0) // the usual case: their boxes are apart
    return best;
  for (const Eigen::Vector4d& plane : first.planes)
    tryAlong (plane.head<3> ());
  for (const Eigen::Vector4d& plane : second.planes)
    tryAlong (-plane.head<3> ());
  if (best.depth_m < 0.0)
    return best;
  const std::vector<Edge> edges_of_second = edgesOf (second);
  for (const Edge& a : edgesOf (first))
    for (const Edge& b : edges_of_second)
      if (makeFace (a, b))
      {
        Eigen::Vector3d direction = a.direction.cross (b.direction);
        if (direction.norm () < least_turn)
          continue;
        direction.normalize ();
        if (direction.dot (a.normals[0] + a.normals[1]) < 0.0)
          direction = -direction;
        if (direction.dot (a.end - b.end) < best.depth_m)
          tryAlong (direction);
      }
  return best;
}

ConvexHull
cutBehind (const ConvexHull& hull, const Eigen::Vector4d& plane)
{
  return convexHullOf (pointsBehind ({hull.corners, hull.triangles}, plane));
}

} // namespace pcl::cosection
