// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "analytic_shape.h"
#include "polygon.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

// Shapes with an axis, z.

namespace pcl::cosection {
namespace {

/** \brief The surface that a profile (distance from the axis, z) leaves when it is turned about z.
 * \param[in] profile counter-clockwise (matter on the left, seen with z up and the axis on the left); its edges on the
 * axis are no surface
 * \param[in] closed whether the last point is joined to the first
 * \param[in] chord_m farthest that triangles may be from the surface */
TriangleMesh
turnedProfile (const Polygon2d& profile, bool closed, double chord_m)
{
  double radius = 0.0;
  for (const Eigen::Vector2d& p : profile)
    radius = std::max (radius, p.x ());
  const auto segments = static_cast<std::uint32_t> (arc ({0.0, 0.0}, radius, 0.0, 2.0 * M_PI, chord_m).size () - 1);
  TriangleMesh mesh;
  std::vector<std::uint32_t> first; // vertex of each point; one on the axis, else segments
  const auto onAxis = [&] (std::size_t n) { return profile[n].x () <= 0.0; };
  for (std::size_t n = 0; n < profile.size (); ++n)
  {
    first.push_back (static_cast<std::uint32_t> (mesh.vertices.size ()));
    for (std::uint32_t s = 0; s < (onAxis (n) ? 1u : segments); ++s)
    {
      const double angle = 2.0 * M_PI * s / segments;
      mesh.vertices.emplace_back (static_cast<float> (profile[n].x () * std::cos (angle)),
                                  static_cast<float> (profile[n].x () * std::sin (angle)),
                                  static_cast<float> (profile[n].y ()));
    }
  }
  for (std::size_t n = 0; n + (closed ? 0 : 1) < profile.size (); ++n)
  {
    const std::size_t m = (n + 1) % profile.size ();
    if (onAxis (n) && onAxis (m))
      continue;
    for (std::uint32_t s = 0; s < segments; ++s)
    {
      const std::uint32_t next = (s + 1) % segments;
      const std::uint32_t a = first[n] + (onAxis (n) ? 0 : s), b = first[n] + (onAxis (n) ? 0 : next);
      const std::uint32_t c = first[m] + (onAxis (m) ? 0 : next), d = first[m] + (onAxis (m) ? 0 : s);
      if (a != b)
        mesh.triangles.push_back ({a, b, c});
      if (c != d)
        mesh.triangles.push_back ({a, c, d});
    }
  }
  return mesh;
}

class Sphere : public AnalyticShape
{
public:
  explicit Sphere (double radius) : radius_ (positive (radius, "radius")) {}

  double distance (const Eigen::Vector3d& p) const override { return p.norm () - radius_; }

  TriangleMesh tessellate (double chord_m) const override
  {
    chord_m *= 0.5; // curved both ways
    Polygon2d profile = arc ({0.0, 0.0}, radius_, -M_PI_2, M_PI_2, chord_m);
    profile.front ().x () = profile.back ().x () = 0.0;
    return turnedProfile (profile, false, chord_m);
  }

private:
  double radius_;
};

class Capsule : public AnalyticShape
{
public:
  Capsule (double radius, double length) : radius_ (positive (radius, "radius")), length_ (positive (length, "length"))
  {}

  double distance (const Eigen::Vector3d& p) const override
  {
    return (p - Eigen::Vector3d (0.0, 0.0, std::clamp (p.z (), 0.0, length_))).norm () - radius_;
  }

  TriangleMesh tessellate (double chord_m) const override
  {
    chord_m *= 0.5; // curved both ways
    Polygon2d profile = arc ({0.0, 0.0}, radius_, -M_PI_2, 0.0, chord_m);
    const Polygon2d upper = arc ({0.0, length_}, radius_, 0.0, M_PI_2, chord_m);
    profile.insert (profile.end (), upper.begin (), upper.end ());
    profile.front ().x () = profile.back ().x () = 0.0;
    return turnedProfile (profile, false, chord_m);
  }

private:
  double radius_;
  double length_;
};

class Torus : public AnalyticShape
{
public:
  Torus (double radius, double tube_radius)
      : radius_ (positive (radius, "radius"))
      , tube_radius_ (positive (tube_radius, "tube_radius"))
  {
    if (!(tube_radius < radius))
      throw InvalidArgument ("tube_radius must be smaller than radius");
  }

  double distance (const Eigen::Vector3d& p) const override
  {
    return std::hypot (std::hypot (p.x (), p.y ()) - radius_, p.z ()) - tube_radius_;
  }

  TriangleMesh tessellate (double chord_m) const override
  {
    chord_m *= 0.5; // curved both ways
    Polygon2d profile = arc ({radius_, 0.0}, tube_radius_, 0.0, 2.0 * M_PI, chord_m);
    profile.pop_back ();
    return turnedProfile (profile, true, chord_m);
  }

private:
  double radius_;
  double tube_radius_;
};

class Revolution : public AnalyticShape
{
public:
  explicit Revolution (const Polygon2d& profile) : profile_ (simplePolygon (profile, "profile"))
  {
    for (const Eigen::Vector2d& p : profile_)
      if (!(p.x () >= 0.0))
        throw InvalidArgument ("profile must not have negative distances from the axis");
  }

  double distance (const Eigen::Vector3d& p) const override
  {
    return polygonDistance (profile_, {std::hypot (p.x (), p.y ()), p.z ()}, true);
  }

  TriangleMesh tessellate (double chord_m) const override { return turnedProfile (profile_, true, chord_m); }

private:
  Polygon2d profile_;
};

} // namespace

Shape::ConstPtr
makeSphere (double radius)
{
  return std::make_shared<Sphere> (radius);
}

Shape::ConstPtr
makeCapsule (double radius, double length)
{
  return std::make_shared<Capsule> (radius, length);
}

Shape::ConstPtr
makeTorus (double radius, double tube_radius)
{
  return std::make_shared<Torus> (radius, tube_radius);
}

Shape::ConstPtr
makeRevolution (const Polygon2d& profile)
{
  return std::make_shared<Revolution> (profile);
}

Shape::ConstPtr
makeCylinder (double radius, double height)
{
  return makeCone (positive (radius, "radius"), radius, height);
}

Shape::ConstPtr
makeCone (double bottom_radius, double top_radius, double height)
{
  positive (height, "height");
  if (!(std::isfinite (bottom_radius) && std::isfinite (top_radius) && bottom_radius >= 0.0 && top_radius >= 0.0 &&
        bottom_radius + top_radius > 0.0))
    throw InvalidArgument ("bottom_radius and top_radius must not be negative, and not both zero");
  Polygon2d profile{{0.0, 0.0}};
  if (bottom_radius > 0.0)
    profile.emplace_back (bottom_radius, 0.0);
  if (top_radius > 0.0)
    profile.emplace_back (top_radius, height);
  profile.emplace_back (0.0, height);
  return std::make_shared<Revolution> (profile);
}

} // namespace pcl::cosection
