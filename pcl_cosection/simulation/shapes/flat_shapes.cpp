// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "analytic_shape.h"
#include "pcl_cosection/common/ear_clipping.h"
#include "polygon.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <map>

// Shapes with flat sides.

namespace pcl::cosection {
namespace {

/** \brief Signed distance of a box whose sides a point is so far beyond. */
template <typename Vector>
double
boxDistance (const Vector& beyond)
{
  return beyond.cwiseMax (0.0).norm () + std::min (0.0, beyond.maxCoeff ());
}

Eigen::Vector3d
halfOf (const Eigen::Vector3d& size)
{
  if (!(size.allFinite () && size.minCoeff () > 0.0))
    throw InvalidArgument ("size must be three positive numbers");
  return 0.5 * size;
}

/** \brief Coordinates of the vertices of a rounded box along an axis: close where it is round. */
std::vector<double>
nodesAlong (double half, double rounding, double chord_m)
{
  if (rounding <= 0.0)
    return {-half, half};
  const double flat = half - rounding;
  std::vector<double> nodes;
  const std::size_t steps = arc ({0.0, 0.0}, rounding, 0.0, M_PI_4, 0.5 * chord_m).size () - 1;
  for (std::size_t n = 0; n <= steps; ++n) // of equal angles: the tangent of up to 45 degrees
    nodes.push_back (flat + rounding * std::tan (M_PI_4 * static_cast<double> (n) / static_cast<double> (steps)));
  std::vector<double> all;
  for (auto node = nodes.rbegin (); node != nodes.rend (); ++node)
    all.push_back (-*node);
  if (flat <= 0.0)
    all.pop_back ();
  all.insert (all.end (), nodes.begin (), nodes.end ());
  return all;
}

class Box : public AnalyticShape
{
public:
  Box (const Eigen::Vector3d& size, double rounding) : half_ (halfOf (size)), rounding_ (rounding)
  {
    if (!(std::isfinite (rounding) && rounding >= 0.0 && rounding <= half_.minCoeff ()))
      throw InvalidArgument ("rounding must be between 0 and half of the smallest size");
  }

  double distance (const Eigen::Vector3d& p) const override
  {
    const Eigen::Vector3d half = half_ - Eigen::Vector3d::Constant (rounding_);
    return boxDistance (Eigen::Vector3d (p.cwiseAbs () - half)) - rounding_;
  }

  TriangleMesh tessellate (double chord_m) const override
  {
    std::array<std::vector<double>, 3> nodes;
    for (int a = 0; a < 3; ++a)
      nodes[a] = nodesAlong (half_[a], rounding_, chord_m);
    TriangleMesh mesh;
    std::map<std::array<std::size_t, 3>, std::uint32_t> numbers;
    const auto vertex = [&] (const std::array<std::size_t, 3>& at) {
      const auto [known, is_new] = numbers.try_emplace (at, static_cast<std::uint32_t> (mesh.vertices.size ()));
      if (is_new)
        mesh.vertices.push_back (onSurface ({nodes[0][at[0]], nodes[1][at[1]], nodes[2][at[2]]}).cast<float> ());
      return known->second;
    };
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const bool upper : {false, true})
        for (std::size_t j = 0; j + 1 < nodes[v].size (); ++j)
          for (std::size_t i = 0; i + 1 < nodes[u].size (); ++i)
          {
            const auto corner = [&] (std::size_t di, std::size_t dj) {
              std::array<std::size_t, 3> at;
              at[axis] = upper ? nodes[axis].size () - 1 : 0;
              at[u] = i + di;
              at[v] = j + dj;
              return vertex (at);
            };
            const std::uint32_t a = corner (0, 0), b = corner (1, 0), c = corner (1, 1), d = corner (0, 1);
            mesh.triangles.push_back (upper ? TriangleMesh::Triangle{a, b, c} : TriangleMesh::Triangle{a, c, b});
            mesh.triangles.push_back (upper ? TriangleMesh::Triangle{a, c, d} : TriangleMesh::Triangle{a, d, c});
          }
    }
    return mesh;
  }

private:
  /** \brief From the surface of the box with sharp edges. */
  Eigen::Vector3d onSurface (const Eigen::Vector3d& p) const
  {
    if (rounding_ <= 0.0)
      return p;
    const Eigen::Vector3d core = half_ - Eigen::Vector3d::Constant (rounding_);
    const Eigen::Vector3d inner = p.cwiseMin (core).cwiseMax (-core);
    return inner + rounding_ * (p - inner).normalized ();
  }

  Eigen::Vector3d half_;
  double rounding_;
};

class Room : public AnalyticShape
{
public:
  explicit Room (const Eigen::Vector3d& size) : box_ (size, 0.0) {}

  double distance (const Eigen::Vector3d& p) const override { return -box_.distance (p); }

  TriangleMesh tessellate (double chord_m) const override
  {
    TriangleMesh mesh = box_.tessellate (chord_m);
    for (TriangleMesh::Triangle& t : mesh.triangles)
      std::swap (t[1], t[2]);
    return mesh;
  }

private:
  Box box_;
};

class HalfSpace : public AnalyticShape
{
public:
  explicit HalfSpace (double extent) : half_ (static_cast<float> (0.5 * positive (extent, "extent"))) {}

  double distance (const Eigen::Vector3d& p) const override { return p.z (); }

  TriangleMesh tessellate (double) const override
  {
    TriangleMesh mesh;
    mesh.vertices = {{-half_, -half_, 0.0f}, {half_, -half_, 0.0f}, {half_, half_, 0.0f}, {-half_, half_, 0.0f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  }

private:
  float half_;
};

class Extrusion : public AnalyticShape
{
public:
  Extrusion (const Polygon2d& outline, double height)
      : outline_ (simplePolygon (outline, "outline"))
      , height_ (positive (height, "height"))
  {}

  double distance (const Eigen::Vector3d& p) const override
  {
    return boxDistance (
        Eigen::Vector2d (polygonDistance (outline_, p.head<2> ()), std::abs (p.z () - 0.5 * height_) - 0.5 * height_));
  }

  TriangleMesh tessellate (double) const override
  {
    TriangleMesh mesh;
    const auto size = static_cast<std::uint32_t> (outline_.size ());
    for (const double z : {0.0, height_})
      for (const Eigen::Vector2d& p : outline_)
        mesh.vertices.emplace_back (static_cast<float> (p.x ()), static_cast<float> (p.y ()), static_cast<float> (z));
    for (const auto& [a, b, c] : clipEars (outline_))
    {
      mesh.triangles.push_back ({a, c, b});
      mesh.triangles.push_back ({a + size, b + size, c + size});
    }
    for (std::uint32_t n = 0; n < size; ++n)
    {
      const std::uint32_t m = (n + 1) % size;
      mesh.triangles.push_back ({n, m, m + size});
      mesh.triangles.push_back ({n, m + size, n + size});
    }
    return mesh;
  }

private:
  Polygon2d outline_;
  double height_;
};

} // namespace

Shape::ConstPtr
makeBox (const Eigen::Vector3d& size, double rounding)
{
  return std::make_shared<Box> (size, rounding);
}

Shape::ConstPtr
makeRoom (const Eigen::Vector3d& size)
{
  return std::make_shared<Room> (size);
}

Shape::ConstPtr
makeHalfSpace (double extent)
{
  return std::make_shared<HalfSpace> (extent);
}

Shape::ConstPtr
makeExtrusion (const Polygon2d& outline, double height)
{
  return std::make_shared<Extrusion> (outline, height);
}

} // namespace pcl::cosection
