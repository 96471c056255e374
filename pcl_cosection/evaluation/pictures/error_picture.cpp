// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "error_picture.h"

#include "picture_canvas.h"

#include "pcl_cosection/mesh/triangle_shape.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr int oversampling = 2;        ///< everything is drawn larger, for smooth edges and letters
constexpr double distance_radii = 4.0; ///< of the camera
constexpr double filled = 0.92;        ///< of a panel, by the meshes
constexpr double ambient_light = 0.55; ///< much, so that colours can be distinguished
constexpr double turn_rad = 2.6;       ///< between the columns
constexpr int title_px = 48;
constexpr int scale_px = 150; ///< width of the column of the scale

/** \brief Gives a surface normals that are smooth but for sharp edges, where vertices are repeated. */
TriangleMesh
withCreasedNormals (const TriangleMesh& mesh)
{
  const double sharp = std::cos (0.6); // radians between neighbours that are apart
  std::vector<Eigen::Vector3d> areas;
  std::vector<std::vector<std::uint32_t>> around (mesh.vertices.size ());
  for (std::uint32_t t = 0; t < mesh.triangles.size (); ++t)
  {
    const auto corner = [&] (int n) { return mesh.vertices[mesh.triangles[t][n]].cast<double> (); };
    areas.push_back (areaVector (corner (0), corner (1), corner (2)));
    for (const std::uint32_t v : mesh.triangles[t])
      around[v].push_back (t);
  }
  TriangleMesh result;
  for (std::uint32_t t = 0; t < mesh.triangles.size (); ++t)
  {
    const auto first = static_cast<std::uint32_t> (result.vertices.size ());
    result.triangles.push_back ({first, first + 1, first + 2});
    for (const std::uint32_t v : mesh.triangles[t])
    {
      Eigen::Vector3d sum = areas[t];
      for (const std::uint32_t other : around[v])
        if (other != t && areas[other].dot (areas[t]) > sharp * areas[other].norm () * areas[t].norm ())
          sum += areas[other];
      result.vertices.push_back (mesh.vertices[v]);
      result.normals.push_back (sum.normalized ().cast<float> ());
    }
  }
  return result;
}

/** \brief A mesh in the colours of its distance to a surface. */
PictureCanvas::Pixels
drawPanel (const TriangleMesh& mesh, const SurfaceDistance& other, const PinholeCamera& camera,
           const Eigen::Isometry3d& T_world_camera, const ErrorPictureOptions& options)
{
  const int size = camera.width;
  Rasterizer rasterizer (camera, T_world_camera, 1e-6);
  rasterizer.draw (mesh, 1);
  const RasterImage& image = rasterizer.image ();

  // The distance of one point for the pixels that become one.
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max ();
  const int blocks = size / oversampling;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> point_of_block (static_cast<std::size_t> (blocks) * blocks, none), pixels, point_of_pixel;
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * size + u;
      if (!std::isfinite (image.depth[pixel]))
        continue;
      std::size_t& point = point_of_block[static_cast<std::size_t> (v / oversampling) * blocks + u / oversampling];
      if (point == none)
      {
        point = points.size ();
        points.push_back (T_world_camera * camera.unproject (u, v, image.depth[pixel]));
      }
      pixels.push_back (pixel);
      point_of_pixel.push_back (point);
    }
  const std::vector<double> errors_m = other.of (points, options.threads);
  PictureCanvas::Pixels result (size, size, cv::Vec3b (255, 255, 255));
  for (std::size_t n = 0; n < pixels.size (); ++n)
  {
    const int u = static_cast<int> (pixels[n] % size), v = static_cast<int> (pixels[n] / size);
    const Eigen::Vector3d to_camera = -camera.unproject (u, v, 1.0).normalized ();
    const double cosine = std::max (0.0, to_camera.dot (image.normals[pixels[n]].cast<double> ()));
    const double light = ambient_light + (1.0 - ambient_light) * cosine;
    const auto colour = errorColour (errors_m[point_of_pixel[n]] / options.error_max_m);
    for (int channel = 0; channel < 3; ++channel)
      result (v, u)[channel] = static_cast<std::uint8_t> (std::lround (light * colour[channel]));
  }
  return result;
}

} // namespace

TriangleMesh::Colour
errorColour (double share)
{
  static constexpr std::array<std::array<double, 3>, 6> stops = {
      {{62, 112, 200}, {48, 168, 186}, {118, 196, 104}, {246, 214, 82}, {238, 131, 48}, {196, 30, 44}}};
  const double place = std::clamp (std::isfinite (share) ? share : 1.0, 0.0, 1.0) * (stops.size () - 1);
  const std::size_t below = std::min (static_cast<std::size_t> (place), stops.size () - 2);
  const double part = place - static_cast<double> (below);
  TriangleMesh::Colour colour;
  for (std::size_t n = 0; n < 3; ++n)
    colour[n] = static_cast<std::uint8_t> (std::lround ((1.0 - part) * stops[below][n] + part * stops[below + 1][n]));
  return colour;
}

std::vector<TriangleMesh::Colour>
errorColours (const std::vector<double>& errors_m, double error_max_m)
{
  if (!(error_max_m > 0.0))
    throw InvalidArgument ("error_max_m must be positive");
  std::vector<TriangleMesh::Colour> colours;
  colours.reserve (errors_m.size ());
  for (const double error_m : errors_m)
    colours.push_back (errorColour (error_m / error_max_m));
  return colours;
}

double
roundErrorUp (double error_m)
{
  constexpr double least_m = 0.001;
  if (!(error_m > least_m))
    return least_m;
  const double power = std::pow (10.0, std::floor (std::log10 (error_m)));
  constexpr double rounding = 1e-9;
  for (const double factor : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (factor * power >= error_m * (1.0 - rounding))
      return factor * power;
  return 10.0 * power;
}

void
ErrorPictureOptions::validate () const
{
  constexpr int least_px = 64, most_px = 4096;
  if (panel_px < least_px || panel_px > most_px)
    throw InvalidArgument ("panel_px must be from 64 to 4096");
  if (!(error_max_m > 0.0 && std::isfinite (error_max_m)))
    throw InvalidArgument ("error_max_m must be a positive number of metres");
  if (!(up.cross (front).norm () > 1e-6 * up.norm () * front.norm ()))
    throw InvalidArgument ("up and front must be different directions");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

Picture
drawErrorPicture (const TriangleMesh& truth, const TriangleMesh& reconstruction, const ErrorPictureOptions& options)
{
  options.validate ();
  const Eigen::AlignedBox3d box = summarizeMesh (truth).box.merged (summarizeMesh (reconstruction).box);
  const double radius_m = 0.5 * box.diagonal ().norm ();
  const Eigen::Vector3d up = options.up.normalized (), front = options.front.normalized ();
  const int panel = options.panel_px;
  const int width = 2 * panel + scale_px, height = 2 * (panel + title_px);
  PictureCanvas canvas (width, height, oversampling);

  const SurfaceDistance to_truth (truth), to_reconstruction (reconstruction);
  const std::array<TriangleMesh, 2> meshes = {withCreasedNormals (reconstruction), withCreasedNormals (truth)};
  const std::array<const SurfaceDistance*, 2> others = {&to_truth, &to_reconstruction};
  const std::array<std::string, 2> captions = {options.reconstruction_caption, options.truth_caption};
  for (int column = 0; column < 2; ++column)
  {
    const Eigen::Vector3d eye = box.center () +
                                distance_radii * radius_m * (Eigen::AngleAxisd (column * turn_rad, up) * front);
    const Eigen::Isometry3d T_world_camera = lookAt (eye, box.center (), up);
    const PinholeCamera camera = fittingCamera ({&meshes[0], &meshes[1]}, T_world_camera, panel * oversampling, filled);
    for (int row = 0; row < 2; ++row)
      drawPanel (meshes[row], *others[row], camera, T_world_camera, options)
          .copyTo (canvas.pixels () (cv::Rect (column * panel * oversampling,
                                               (row * (panel + title_px) + title_px) * oversampling,
                                               panel * oversampling, panel * oversampling)));
  }
  for (int row = 0; row < 2; ++row)
    canvas.write (captions[row], 20, row * (panel + title_px) + 32, 0.62);
  const int scale_height = std::min (360, height / 2);
  canvas.drawScale (cv::Rect (2 * panel + 20, (height - scale_height) / 2, 26, scale_height),
                    {{"error", "in mm"}, 0.0, 1000.0 * options.error_max_m, true});
  return canvas.picture ();
}

} // namespace pcl::cosection
