// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Written by hand, because VTK's rendering needs a display even off the screen.

#include "frustum_clip.h"
#include "pixel_coverage.h"

#include "pcl_cosection/mesh/mesh_checks.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

using Colour = TriangleMesh::Colour;

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
