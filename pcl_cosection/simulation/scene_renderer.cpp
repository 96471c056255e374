// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/scene_renderer.h>

#include "pcl_cosection/simulation/shapes/sine_table.h"

#include <pcl/cosection/rendering/rasterizer.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double chord_m = 2e-5;      // between triangles and an analytic surface
constexpr double search_chords = 5.0; // a ray meets the surface where it meets the triangles, or so far from there
constexpr double precision_m = 1e-7;
constexpr double flat_m = 1e-6; // triangles so near to the surface are the surface: flat sides
constexpr int max_steps = 20;
constexpr double least_cosine = 0.02; // between ray and normal, where the search is widest

const Eigen::Vector3d light = Eigen::Vector3d (0.35, -0.5, 0.8).normalized (); // world frame
constexpr double ambient = 0.45;
constexpr double pattern_contrast = 0.2;

/** \brief -1 to 1. */
double
pattern (const Eigen::Vector3d& p, double period)
{
  const SineTable& table = sineTable ();
  const Eigen::Vector3d turns = p / period;
  return (table.sine (turns.x ()) * table.cosine (turns.y ()) + table.sine (turns.y ()) * table.cosine (turns.z ()) +
          table.sine (turns.z ()) * table.cosine (turns.x ())) /
         1.5;
}

TriangleMesh::Colour
lit (const TriangleMesh::Colour& colour, double brightness)
{
  TriangleMesh::Colour result;
  for (int c = 0; c < 3; ++c)
    result[c] = static_cast<std::uint8_t> (std::lround (std::clamp (brightness * colour[c], 0.0, 255.0)));
  return result;
}

} // namespace

SceneRenderer::SceneRenderer (const SimulatedScene& scene) : scene_ (scene)
{
  scene_.validate ();
  for (std::size_t b = 0; b < scene_.bodies.size (); ++b)
    for (const BodyPart& part : scene_.bodies[b].parts)
    {
      parts_.push_back ({&part, b, part.shape->tessellate (chord_m)});
      if (part.shape->isAnalytic ())
        parts_.back ().mesh.normals.clear ();
    }
}

double
SceneRenderer::refined (const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, double z) const
{
  // Regula falsi (Illinois) on either side of where the triangles are; where the ray passes an edge of the shape
  // without meeting it, the triangles' depth is as near as there is.
  const double length = ray.norm ();
  const auto distance = [&] (double at) { return shape.distance (origin + at * ray); };
  const double here = distance (z);
  if (std::abs (here) < flat_m)
    return z;
  const double search_m = std::max (search_chords * chord_m, 2.0 * std::abs (here)) / least_cosine / length;
  double step = std::max (2.0 * std::abs (here), precision_m) / length;
  double a = z, fa = here, b = z, fb = here;
  // Towards the surface: forward if in front of it, back if inside.
  const double direction = here > 0.0 ? 1.0 : -1.0;
  while ((fa > 0.0) == (fb > 0.0))
  {
    if (std::abs (b - z) > search_m || fb == 0.0)
      return fb == 0.0 ? b : z;
    a = b;
    fa = fb;
    b += direction * step;
    fb = distance (b);
    step *= 2.0;
  }
  for (int n = 0; n < max_steps && std::abs (b - a) * length > precision_m; ++n)
  {
    const double c = (a * fb - b * fa) / (fb - fa);
    const double fc = distance (c);
    if ((fc > 0.0) != (fb > 0.0))
    {
      a = b;
      fa = fb;
    }
    else
      fa *= 0.5;
    b = c;
    fb = fc;
    if (std::abs (fc) < 0.01 * precision_m)
      break;
  }
  return b;
}

SimulatedFrame
SceneRenderer::render (double time) const
{
  const PinholeCamera& camera = scene_.camera;
  SimulatedFrame frame;
  frame.T_world_camera = scene_.camera_motion.at (time);
  frame.colour = Picture (camera.width, camera.height, {0, 0, 0});
  frame.depth = Image<float> (camera.width, camera.height);
  frame.mask = Image<std::uint16_t> (camera.width, camera.height, 0);

  std::vector<Eigen::Isometry3d> T_world_body;
  for (const SceneBody& body : scene_.bodies)
    T_world_body.push_back (body.motion.at (time));
  Rasterizer rasterizer (camera, frame.T_world_camera);
  std::vector<Eigen::Isometry3d> T_part_camera;
  for (std::size_t p = 0; p < parts_.size (); ++p)
  {
    const Eigen::Isometry3d T_world_part = T_world_body[parts_[p].body] * parts_[p].part->T_body_part;
    rasterizer.draw (parts_[p].mesh, static_cast<int> (p), T_world_part, parts_[p].part->colour);
    T_part_camera.push_back (T_world_part.inverse () * frame.T_world_camera);
  }
  const RasterImage& image = rasterizer.image ();
  frame.normals = image.normals;
  const Eigen::Vector3d light_camera = frame.T_world_camera.linear ().transpose () * light;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
      frame.depth.pixels[pixel] = image.depth[pixel];
      if (image.ids[pixel] < 0)
        continue;
      const DrawnPart& part = parts_[image.ids[pixel]];
      const SceneBody& body = scene_.bodies[part.body];
      const Eigen::Isometry3d& T = T_part_camera[image.ids[pixel]];
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      if (part.part->shape->isAnalytic ())
        frame.depth.pixels[pixel] = static_cast<float> (
            refined (*part.part->shape, T.translation (), T.linear () * ray, image.depth[pixel]));
      frame.mask.pixels[pixel] = static_cast<std::uint16_t> (body.id);
      double brightness = ambient +
                          (1.0 - ambient) * std::max (0.0, light_camera.dot (image.normals[pixel].cast<double> ()));
      if (body.pattern_size_m > 0.0)
        brightness *= 1.0 + pattern_contrast * pattern (T * (image.depth[pixel] * ray), body.pattern_size_m);
      frame.colour.pixels[pixel] = lit (image.colours[pixel], brightness);
    }
  return frame;
}

} // namespace pcl::cosection
