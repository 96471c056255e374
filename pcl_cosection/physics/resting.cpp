// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/resting.h"

#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/physics/convex_hull_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace pcl::cosection {

namespace {

// A centre over the edge of the contact polygon would tip: it is moved this share of the way on to the polygon's
// middle. With a contact polygon 30 mm wide, 0.05 is enough for MuJoCo, and 0.1 not always for Bullet, which adds a
// margin.
constexpr double margin = 0.2;
constexpr int halvings = 30; // of the way there
constexpr std::size_t most_feet = 8;

using Polygon = std::vector<Eigen::Vector2d>;

/** \brief Leave out the corners that cut off least (as M. Visvalingam and J. D. Whyatt do to lines, 1993). */
Polygon
fewerCorners (Polygon polygon)
{
  while (polygon.size () > most_feet)
  {
    double least = std::numeric_limits<double>::infinity ();
    std::size_t chosen = 0;
    for (std::size_t n = 0; n < polygon.size (); ++n)
    {
      const Eigen::Vector2d &before = polygon[(n + polygon.size () - 1) % polygon.size ()], &here = polygon[n];
      const Eigen::Vector2d& after = polygon[(n + 1) % polygon.size ()];
      if (const double area = cross<double> (here - before, after - before); area < least)
      {
        least = area;
        chosen = n;
      }
    }
    polygon.erase (polygon.begin () + static_cast<std::ptrdiff_t> (chosen));
  }
  return polygon;
}

} // namespace

double
lowestOver (const Eigen::Vector4d& plane, const TriangleMesh& mesh)
{
  double lowest = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    lowest = std::min (lowest, heightOver (plane, vertex.cast<double> ()));
  return lowest;
}

TriangleMesh
flattenedOn (const Eigen::Vector4d& plane, TriangleMesh mesh, double band_m)
{
  for (Eigen::Vector3f& vertex : mesh.vertices)
  {
    const Eigen::Vector3d p = vertex.cast<double> ();
    if (const double height = heightOver (plane, p); height < band_m)
      vertex = (p - height * plane.head<3> ()).cast<float> ();
  }
  return mesh;
}

Stance
stanceOf (const std::vector<Eigen::Vector3d>& points, const Eigen::Vector4d& plane, const Eigen::Vector3d& centre_m,
          double tolerance_m)
{
  const Eigen::Quaterniond to_vertical = Eigen::Quaterniond::FromTwoVectors (plane.head<3> (),
                                                                             Eigen::Vector3d::UnitZ ());
  const auto footOf = [&] (const Eigen::Vector3d& p) { return Eigen::Vector2d ((to_vertical * p).head<2> ()); };
  std::vector<Eigen::Vector2d> feet;
  for (const Eigen::Vector3d& p : points)
    if (heightOver (plane, p) < tolerance_m)
      feet.push_back (footOf (p));
  Stance stance;
  stance.centre = centre_m;
  const Polygon polygon = convexHull (feet);
  if (polygon.size () < 3)
    return stance;
  for (const Eigen::Vector2d& corner : fewerCorners (polygon))
    stance.feet.push_back (to_vertical.inverse () * Eigen::Vector3d (corner.x (), corner.y (), -plane[3]));
  Eigen::Vector2d middle = Eigen::Vector2d::Zero ();
  for (const Eigen::Vector2d& corner : polygon)
    middle += corner / static_cast<double> (polygon.size ());
  std::vector<Eigen::Vector2d> stable;
  for (const Eigen::Vector2d& corner : polygon)
    stable.push_back (corner + margin * (middle - corner));
  const Eigen::Vector2d from = footOf (centre_m);
  stance.stands = true;
  if (isInside (stable, from))
    return stance;
  double outside = 0.0, inside = 1.0;
  for (int n = 0; n < halvings; ++n)
  {
    const double half = 0.5 * (outside + inside);
    (isInside (stable, Eigen::Vector2d (from + half * (middle - from))) ? inside : outside) = half;
  }
  const Eigen::Vector2d shift = inside * (middle - from);
  stance.centre = centre_m + to_vertical.inverse () * Eigen::Vector3d (shift.x (), shift.y (), 0.0);
  stance.shift_m = shift.norm ();
  stance.stands = convexHullOf (points).depthOf (stance.centre) > 0.0;
  if (!stance.stands)
  {
    stance.shift_m = 0.0;
    stance.centre = centre_m;
  }
  return stance;
}

} // namespace pcl::cosection
