// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Written by hand, because VTK's rendering needs a display even off the screen.

#include "pcl_cosection/mesh/mesh_checks.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

using Colour = TriangleMesh::Colour;

/** \brief A convex polygon in the sensor frame: a triangle after clipping. */
struct ClippedPolygon
{
  static constexpr int max_corners = 8; ///< a triangle cut by five planes

  std::array<Eigen::Vector3d, max_corners> corners;
  int count = 0;
};

/** \brief Cuts triangles at the near plane and, far outside of the picture, at its sides, so that
 * pixel coordinates stay small. Two triangles of one edge are cut in the same points of it. */
class FrustumClip
{
public:
  FrustumClip (const PinholeCamera& camera, double near_m)
  {
    // Pixel column u = fx x/z + cx >= -g becomes fx x + (cx + g) z >= 0; likewise at the other sides.
    constexpr double g = 8192.0; // how far outside of the picture coordinates may be, pixels
    normals_ = {Eigen::Vector3d (0, 0, 1), Eigen::Vector3d (camera.fx, 0, camera.cx + g),
                Eigen::Vector3d (-camera.fx, 0, camera.width + g - camera.cx),
                Eigen::Vector3d (0, camera.fy, camera.cy + g),
                Eigen::Vector3d (0, -camera.fy, camera.height + g - camera.cy)};
    offsets_ = {near_m, 0, 0, 0, 0};
  }

  bool contains (const Eigen::Vector3d& p) const
  {
    for (int plane = 0; plane < plane_count; ++plane)
      if (!(distance (plane, p) >= 0.0))
        return false;
    return true;
  }

  ClippedPolygon clip (const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) const
  {
    ClippedPolygon polygon{{a, b, c}, 3};
    for (int plane = 0; plane < plane_count && polygon.count > 0; ++plane)
    {
      ClippedPolygon cut;
      for (int n = 0; n < polygon.count; ++n)
      {
        const Eigen::Vector3d& p = polygon.corners[n];
        const Eigen::Vector3d& q = polygon.corners[(n + 1) % polygon.count];
        const double dp = distance (plane, p);
        const double dq = distance (plane, q);
        if (dp >= 0.0 && cut.count < ClippedPolygon::max_corners)
          cut.corners[cut.count++] = p;
        // from the end inside, whichever comes first here: the neighbour goes the other way round
        if ((dp >= 0.0) != (dq >= 0.0) && cut.count < ClippedPolygon::max_corners)
          cut.corners[cut.count++] = dp >= 0.0 ? crossing (p, q, dp, dq) : crossing (q, p, dq, dp);
      }
      polygon = cut;
    }
    return polygon;
  }

private:
  static constexpr int plane_count = 5;

  double distance (int plane, const Eigen::Vector3d& p) const { return normals_[plane].dot (p) - offsets_[plane]; }

  static Eigen::Vector3d crossing (const Eigen::Vector3d& from, const Eigen::Vector3d& to, double d_from, double d_to)
  {
    return from + d_from / (d_from - d_to) * (to - from);
  }

  std::array<Eigen::Vector3d, plane_count> normals_;
  std::array<double, plane_count> offsets_;
};

/** \brief Pixel coordinates in 1/256 of a pixel: coverage is decided in exact integer arithmetic. */
struct SubpixelPoint
{
  static constexpr int subpixels = 256;

  std::int64_t x = 0;
  std::int64_t y = 0;

  static SubpixelPoint fromPixel (const Eigen::Vector2d& pixel)
  {
    return {std::llround (pixel.x () * subpixels), std::llround (pixel.y () * subpixels)};
  }
};

/** \brief Call visit (u, v) for every pixel of a width * height picture whose centre lies in the
 * triangle, whichever its orientation.
 *
 * A centre exactly on a side belongs to the triangle to whose left or top the side is: of two
 * triangles that share it, just one covers the pixel (J. Pineda, "A Parallel Algorithm for Polygon
 * Rasterization", SIGGRAPH 1988). */
template <typename Visit>
void
forEachCoveredPixel (SubpixelPoint a, SubpixelPoint b, SubpixelPoint c, int width, int height, Visit&& visit)
{
  const auto twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (twice_area == 0)
    return;
  if (twice_area < 0)
    std::swap (b, c);

  // value (x, y) = dx y - dy x + constant >= 0 on the inner side
  struct SideFunction
  {
    SideFunction (const SubpixelPoint& p, const SubpixelPoint& q)
        : step_u (-(q.y - p.y) * SubpixelPoint::subpixels)
        , step_v ((q.x - p.x) * SubpixelPoint::subpixels)
        , constant ((q.y - p.y) * p.x - (q.x - p.x) * p.y)
    {
      const bool owns_points_on_it = q.y < p.y || (q.y == p.y && q.x > p.x);
      if (!owns_points_on_it)
        --constant;
    }

    std::int64_t at (int u, int v) const { return constant + step_u * u + step_v * v; }

    std::int64_t step_u;
    std::int64_t step_v;
    std::int64_t constant;
  };
  const SideFunction ab (a, b);
  const SideFunction bc (b, c);
  const SideFunction ca (c, a);

  const auto firstCentre = [] (std::int64_t x) { // the least pixel whose centre is not before x
    return static_cast<int> (std::ceil (static_cast<double> (x) / SubpixelPoint::subpixels));
  };
  const auto lastCentre = [] (std::int64_t x) {
    return static_cast<int> (std::floor (static_cast<double> (x) / SubpixelPoint::subpixels));
  };
  const int u_begin = std::max (0, firstCentre (std::min ({a.x, b.x, c.x})));
  const int v_begin = std::max (0, firstCentre (std::min ({a.y, b.y, c.y})));
  const int u_last = std::min (width - 1, lastCentre (std::max ({a.x, b.x, c.x})));
  const int v_last = std::min (height - 1, lastCentre (std::max ({a.y, b.y, c.y})));
  for (int v = v_begin; v <= v_last; ++v)
  {
    std::int64_t e_ab = ab.at (u_begin, v);
    std::int64_t e_bc = bc.at (u_begin, v);
    std::int64_t e_ca = ca.at (u_begin, v);
    for (int u = u_begin; u <= u_last; ++u)
    {
      if ((e_ab | e_bc | e_ca) >= 0)
        visit (u, v);
      e_ab += ab.step_u;
      e_bc += bc.step_u;
      e_ca += ca.step_u;
    }
  }
}

/** \brief Where the rays of a camera meet the plane of a triangle.
 *
 * The ray r through a pixel meets the triangle's plane at z r = b_0 p_0 + b_1 p_1 + b_2 p_2 with
 * sum b = 1. By Cramer's rule b_i = w_i / sum w, where w_i = r . (p_j x p_k), and
 * z = p_0 . (p_1 x p_2) / sum w: exact in perspective, and the same however the triangle was clipped. */
class TrianglePlane
{
public:
  TrianglePlane (const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2, double near_m)
      : determinant_ (p0.dot (p1.cross (p2)))
      , z_min_ (std::max (near_m, std::min ({p0.z (), p1.z (), p2.z ()})))
      , z_max_ (std::max ({p0.z (), p1.z (), p2.z ()}))
  {
    weights_.row (0) = p1.cross (p2);
    weights_.row (1) = p2.cross (p0);
    weights_.row (2) = p0.cross (p1);
    normal_ = (p1 - p0).cross (p2 - p0);
    // Seen from the camera at 0, the outer side is the visible one if n . p < 0.
    faces_camera_ = normal_.dot (p0) <= 0.0;
  }

  /** \brief Depth along the ray, kept within the triangle's where it is seen edge-on. */
  double depth (const Eigen::Vector3d& ray) const
  {
    const double z = determinant_ / (weights_ * ray).sum ();
    return std::isfinite (z) ? std::clamp (z, z_min_, z_max_) : z_min_;
  }

  Eigen::Vector3d barycentric (const Eigen::Vector3d& ray) const
  {
    const Eigen::Vector3d w = (weights_ * ray) / (weights_ * ray).sum ();
    if (!w.allFinite ())
      return Eigen::Vector3d::Constant (1.0 / 3.0);
    const Eigen::Vector3d clamped = w.cwiseMax (0.0); // a pixel's centre may lie a rounding error outside
    return clamped / clamped.sum ();
  }

  /** \brief Normal of any length, towards the camera's side. */
  Eigen::Vector3d normal () const { return faces_camera_ ? normal_ : -normal_; }

  bool facesCamera () const { return faces_camera_; }

private:
  Eigen::Matrix3d weights_;
  Eigen::Vector3d normal_;
  double determinant_;
  double z_min_;
  double z_max_;
  bool faces_camera_;
};

Colour
blend (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle, const Eigen::Vector3d& b)
{
  Colour colour;
  for (int channel = 0; channel < 3; ++channel)
  {
    double sum = 0.0;
    for (int n = 0; n < 3; ++n)
      sum += b[n] * mesh.colours[triangle[n]][channel];
    colour[channel] = static_cast<std::uint8_t> (std::lround (std::clamp (sum, 0.0, 255.0)));
  }
  return colour;
}

/** \brief Unit vector along \a v, or along \a fallback if that has no direction. */
Eigen::Vector3f
direction (const Eigen::Vector3d& v, const Eigen::Vector3d& fallback)
{
  const double norm = v.norm ();
  const Eigen::Vector3d chosen = (norm > 1e-12 && std::isfinite (norm)) ? v : fallback;
  return chosen.stableNormalized ().cast<float> ();
}

} // namespace

Rasterizer::Rasterizer (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, double near_m)
    : camera_ (camera)
    , T_camera_world_ (T_world_camera.inverse ())
    , near_m_ (near_m)
{
  camera.validate ();
  if (!(near_m > 0.0))
    throw InvalidArgument ("rasteriser: the near distance must be positive");
  const std::size_t pixels = static_cast<std::size_t> (camera.width) * camera.height;
  image_.width = camera.width;
  image_.height = camera.height;
  image_.depth.assign (pixels, std::numeric_limits<float>::quiet_NaN ());
  image_.normals.assign (pixels, Eigen::Vector3f::Zero ());
  image_.ids.assign (pixels, -1);
  image_.colours.assign (pixels, {0, 0, 0});
}

void
Rasterizer::draw (const TriangleMesh& mesh, int id, const Eigen::Isometry3d& T_world_mesh, const Colour& colour)
{
  checkMesh (mesh);
  const Eigen::Isometry3d T_camera_mesh = T_camera_world_ * T_world_mesh;
  const FrustumClip frustum (camera_, near_m_);
  std::vector<Eigen::Vector3d> positions (mesh.vertices.size ());
  std::vector<SubpixelPoint> pixels (mesh.vertices.size ());
  std::vector<bool> in_frustum (mesh.vertices.size ());
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    positions[v] = T_camera_mesh * mesh.vertices[v].cast<double> ();
    in_frustum[v] = frustum.contains (positions[v]);
    if (in_frustum[v])
      pixels[v] = SubpixelPoint::fromPixel (camera_.project (positions[v]));
  }

  for (const auto& triangle : mesh.triangles)
  {
    const auto& p = positions;
    const std::uint32_t a = triangle[0], b = triangle[1], c = triangle[2];
    if (!p[a].allFinite () || !p[b].allFinite () || !p[c].allFinite ())
      continue;
    const TrianglePlane plane (p[a], p[b], p[c], near_m_);
    const auto shadePixel = [&] (int u, int v) {
      const Eigen::Vector3d ray = camera_.unproject (u, v, 1.0);
      const auto z = static_cast<float> (plane.depth (ray));
      const std::size_t pixel = static_cast<std::size_t> (v) * camera_.width + u;
      if (image_.depth[pixel] <= z) // false where the depth is NaN
        return;
      image_.depth[pixel] = z;
      image_.ids[pixel] = id;
      const Eigen::Vector3d weights = plane.barycentric (ray);
      Eigen::Vector3d normal = plane.normal ();
      if (!mesh.normals.empty ())
      {
        normal = T_camera_mesh.linear () *
                 (weights[0] * mesh.normals[a].cast<double> () + weights[1] * mesh.normals[b].cast<double> () +
                  weights[2] * mesh.normals[c].cast<double> ());
        if (!plane.facesCamera ())
          normal = -normal;
      }
      image_.normals[pixel] = direction (normal, plane.normal ());
      image_.colours[pixel] = mesh.colours.empty () ? colour : blend (mesh, triangle, weights);
    };
    if (in_frustum[a] && in_frustum[b] && in_frustum[c])
    {
      forEachCoveredPixel (pixels[a], pixels[b], pixels[c], camera_.width, camera_.height, shadePixel);
      continue;
    }
    const ClippedPolygon polygon = frustum.clip (p[a], p[b], p[c]);
    const auto corner = [&] (int n) { return SubpixelPoint::fromPixel (camera_.project (polygon.corners[n])); };
    for (int n = 2; n < polygon.count; ++n)
      forEachCoveredPixel (corner (0), corner (n - 1), corner (n), camera_.width, camera_.height, shadePixel);
  }
}

void
Rasterizer::drawPoints (const std::vector<Eigen::Vector3f>& points, const std::vector<Colour>& colours, int id,
                        int size_px)
{
  if (!colours.empty () && colours.size () != points.size ())
    throw InvalidArgument ("rasteriser: there must be one colour per point, or none");
  if (size_px < 1)
    throw InvalidArgument ("rasteriser: points must be at least one pixel large");
  const Colour grey = {200, 200, 200};
  const FrustumClip frustum (camera_, near_m_);
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const Eigen::Vector3d p = T_camera_world_ * points[n].cast<double> ();
    if (!frustum.contains (p)) // also if it is not finite
      continue;
    const Eigen::Vector2d pixel = camera_.project (p);
    const int u_begin = static_cast<int> (std::lround (pixel.x () - 0.5 * (size_px - 1)));
    const int v_begin = static_cast<int> (std::lround (pixel.y () - 0.5 * (size_px - 1)));
    const auto z = static_cast<float> (p.z ());
    for (int v = std::max (0, v_begin); v < std::min (camera_.height, v_begin + size_px); ++v)
      for (int u = std::max (0, u_begin); u < std::min (camera_.width, u_begin + size_px); ++u)
      {
        const std::size_t index = static_cast<std::size_t> (v) * camera_.width + u;
        if (image_.depth[index] <= z)
          continue;
        image_.depth[index] = z;
        image_.ids[index] = id;
        image_.normals[index] = (-p).normalized ().cast<float> ();
        image_.colours[index] = colours.empty () ? grey : colours[n];
      }
  }
}

} // namespace pcl::cosection
