// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// make_demo_scene OUTPUT.pcd: renders the sample of the demo, a box, a ball and a bottle on a table, as a
// structured-light camera sees them from one side. The same file every time.

#include "shapes.h"

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr double baseline_m = 0.075;     ///< between the projector and the camera
constexpr double shadow_margin_m = 0.01; ///< a point this much behind what the projector sees is in shadow
constexpr double edge_jitter_px = 0.4;   ///< standard deviation of where a depth is read, across depth edges
constexpr double min_incidence = 0.17;   ///< cosine; at flatter angles the pattern is not recognised
constexpr float missing = std::numeric_limits<float>::quiet_NaN ();

/** \brief A shape, where it is, and how it is labelled. */
struct Body
{
  int label;
  TriangleMesh mesh;
  Eigen::Isometry3d T_world_body;
  TriangleMesh::Colour colour;
};

Eigen::Isometry3d
at (double x, double y, double z, double turn_rad = 0.0)
{
  return (Eigen::Translation3d (x, y, z) * Eigen::AngleAxisd (turn_rad, Eigen::Vector3d::UnitZ ()));
}

std::vector<Body>
makeBodies ()
{
  const TriangleMesh bottle = revolve ({{0.0f, 0.0f},
                                        {0.036f, 0.0f},
                                        {0.038f, 0.002f},
                                        {0.038f, 0.110f},
                                        {0.034f, 0.125f},
                                        {0.020f, 0.145f},
                                        {0.015f, 0.155f},
                                        {0.015f, 0.190f},
                                        {0.0f, 0.190f}});
  return {{0, makeBox ({1.3f, 1.1f, 0.03f}), at (0.0, 0.15, -0.015), {196, 164, 124}},
          {0, makeBox ({6.0f, 6.0f, 0.03f}), at (0.0, 0.0, -0.75), {120, 120, 125}},
          {1, makeBox ({0.16f, 0.10f, 0.12f}), at (-0.11, 0.03, 0.06, 0.5), {60, 120, 190}},
          {2, makeBall (0.055f), at (0.035, -0.045, 0.055), {205, 75, 60}},
          {3, bottle, at (0.145, 0.06, 0.0), {80, 160, 95}}};
}

RasterImage
render (const std::vector<Body>& bodies, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera)
{
  Rasterizer rasterizer (camera, T_world_camera);
  for (const Body& body : bodies)
    rasterizer.draw (body.mesh, body.label, body.T_world_body, body.colour);
  return (rasterizer.image ());
}

/** \brief Normal distribution by Box and Muller; std::normal_distribution differs between standard libraries. */
class Gauss
{
public:
  double operator() ()
  {
    const double radius = std::sqrt (-2.0 * std::log (uniform ()));
    return (radius * std::cos (2.0 * M_PI * uniform ()));
  }

private:
  double uniform () { return ((generator_ () + 0.5) / 4294967296.0); }

  std::mt19937 generator_{2020};
};

/** \brief Whether the projector reaches the point \a p of the camera frame. */
bool
isLit (const Eigen::Vector3d& p, const RasterImage& seen_by_projector, const PinholeCamera& camera)
{
  const Eigen::Vector2d pixel = camera.project (p - Eigen::Vector3d (baseline_m, 0.0, 0.0));
  const auto u = static_cast<int> (std::lround (pixel.x ()));
  const auto v = static_cast<int> (std::lround (pixel.y ()));
  if (u < 0 || v < 0 || u >= camera.width || v >= camera.height)
    return (true);
  const float depth = seen_by_projector.depth[static_cast<std::size_t> (v) * camera.width + u];
  return (!(p.z () > depth + shadow_margin_m));
}

/** \brief The cloud that a structured-light camera measures, with labels and colours. */
pcl::PointCloud<pcl::PointXYZRGBL>
measure (const std::vector<Body>& bodies, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera)
{
  const RasterImage image = render (bodies, camera, T_world_camera);
  const RasterImage seen_by_projector = render (bodies, camera,
                                                T_world_camera * Eigen::Translation3d (baseline_m, 0.0, 0.0));
  const Picture picture = shade (image, camera);

  Gauss gauss;
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const auto read_u = std::clamp (static_cast<int> (std::lround (u + edge_jitter_px * gauss ())), 0,
                                      camera.width - 1);
      const auto read_v = std::clamp (static_cast<int> (std::lround (v + edge_jitter_px * gauss ())), 0,
                                      camera.height - 1);
      const double noise = gauss ();
      const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
      const std::size_t read = static_cast<std::size_t> (read_v) * camera.width + read_u;

      pcl::PointXYZRGBL& point = cloud (u, v);
      point.x = point.y = point.z = missing;
      point.r = picture.pixels[pixel][0];
      point.g = picture.pixels[pixel][1];
      point.b = picture.pixels[pixel][2];
      point.label = static_cast<std::uint32_t> (std::max (0, image.ids[pixel]));

      // Within one surface a jittered reading would only add noise of another kind.
      const bool same_surface = image.ids[read] == image.ids[pixel];
      const double depth = image.depth[same_surface ? pixel : read];
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      const double incidence = -ray.normalized ().dot (image.normals[pixel].cast<double> ());
      if (!std::isfinite (depth) || incidence < min_incidence || !isLit (depth * ray, seen_by_projector, camera))
        continue;
      point.getVector3fMap () = ((depth + noise * depthNoiseSigma (depth)) * ray).cast<float> ();
    }
  cloud.is_dense = false;
  cloud.sensor_origin_ << T_world_camera.translation ().cast<float> (), 1.0f;
  cloud.sensor_orientation_ = Eigen::Quaternionf (T_world_camera.linear ().cast<float> ());
  return (cloud);
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc != 2)
  {
    std::cerr << "Usage: make_demo_scene OUTPUT.pcd\n";
    return (2);
  }
  try
  {
    const PinholeCamera camera{320, 240, 262.5, 262.5, 159.5, 119.5};
    const Eigen::Isometry3d T_world_camera = lookAt ({0.02, -0.55, 0.42}, {0.02, 0.02, 0.05});
    if (pcl::io::savePCDFileBinaryCompressed (argv[1], measure (makeBodies (), camera, T_world_camera)) != 0)
      throw std::runtime_error (std::string ("cannot write ") + argv[1]);
    return (0);
  }
  catch (const std::exception& error)
  {
    std::cerr << "make_demo_scene: " << error.what () << '\n';
    return (1);
  }
}
