// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_pictures.h"

#include "embedding.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/rendering/rasterizer.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

namespace {

constexpr int scene_width_px = 720, scene_height_px = 430;
constexpr int panel_px = 400;
constexpr int oversampling = 2;                         ///< each way
constexpr double distance_radii = 4.0;                  ///< of the camera
constexpr double filled = 0.94;                         ///< of a panel
constexpr double elevation_rad = 0.45;                  ///< of the camera at least
constexpr double turn_rad = 2.6;                        ///< from the front to the back
constexpr TriangleMesh::Colour plain = {200, 200, 200}; ///< of a mesh without colours

/** \brief Light from above on the left, and much from everywhere: hidden sides are to be seen. */
double
lightOn (const Eigen::Vector3f& normal)
{
  static const Eigen::Vector3f to_lamp = Eigen::Vector3f (-0.4f, -0.7f, -1.0f)
                                             .normalized (); // x right, y down, z forward
  constexpr double ambient = 0.56, lamp = 0.5;
  return (ambient + lamp * std::max (0.0f, normal.dot (to_lamp)));
}

/** \brief The mean of the pixels that something covers; opaque as far as that is all of them. */
void
shrinkInto (const RasterImage& image, TransparentPicture& result, int top)
{
  const int size = image.width / oversampling;
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u)
    {
      int covered = 0;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
      for (int n = 0; n < oversampling * oversampling; ++n)
      {
        const int x = u * oversampling + n % oversampling, y = v * oversampling + n / oversampling;
        const std::size_t pixel = static_cast<std::size_t> (y) * image.width + x;
        if (!std::isfinite (image.depth[pixel]))
          continue;
        ++covered;
        const TriangleMesh::Colour& colour = image.colours[pixel];
        sum += lightOn (image.normals[pixel]) * Eigen::Vector3d (colour[0], colour[1], colour[2]);
      }
      if (covered == 0)
        continue;
      const Eigen::Vector3d mean = (sum / covered).cwiseMin (255.0);
      const auto byte = [] (double value) { return (static_cast<std::uint8_t> (std::lround (value))); };
      result.at (u, top + v) = {byte (mean[0]), byte (mean[1]), byte (mean[2]),
                                byte (255.0 * covered / (oversampling * oversampling))};
    }
}

/** \brief A mesh from the side of the camera above the same from behind, on nothing.
 * \param[in] fit_to what fills the picture; the same for all pictures of an object */
TransparentPicture
drawFrontAndBack (const TriangleMesh& mesh, const TriangleMesh& fit_to, const ObjectDirections& directions)
{
  const Eigen::AlignedBox3d box = vertexBox (fit_to);
  const Eigen::Vector3d up = directions.up;
  const Eigen::Vector3d horizontal = (directions.front - directions.front.dot (up) * up).normalized ();
  const double elevation = std::max (elevation_rad, std::asin (std::clamp (directions.front.dot (up), -1.0, 1.0)));
  const Eigen::Vector3d front = std::cos (elevation) * horizontal + std::sin (elevation) * up;
  TransparentPicture result (panel_px, 2 * panel_px, {255, 255, 255, 0});
  for (int row = 0; row < 2; ++row)
  {
    const Eigen::Vector3d eye = box.center () + distance_radii * 0.5 * box.diagonal ().norm () *
                                                    (Eigen::AngleAxisd (row * turn_rad, up) * front);
    const Eigen::Isometry3d T_object_camera = Viewpoint{eye, box.center (), up}.pose ();
    const PinholeCamera camera = fittingCamera ({&fit_to}, T_object_camera, oversampling * panel_px, filled);
    Rasterizer rasterizer (camera, T_object_camera, 1e-6);
    rasterizer.draw (mesh, 1, Eigen::Isometry3d::Identity (), plain);
    shrinkInto (rasterizer.image (), result, row * panel_px);
  }
  return (result);
}

template <typename Picture>
Json
pictureJson (const Picture& picture, const std::string& caption, const std::string& alternative)
{
  return {{"uri", dataUri (picture)},
          {"caption", caption},
          {"alternative", alternative},
          {"width", picture.width},
          {"height", picture.height}};
}

} // namespace

Json
drawObject (const RunObject& object, const ObjectDirections& directions, const std::vector<double>& errors_m,
            double error_max_m, const std::string& name)
{
  Json pictures = Json::array ();
  TriangleMesh fit_to; // both, as points
  fit_to.vertices = object.completed.vertices;
  fit_to.vertices.insert (fit_to.vertices.end (), object.seen.vertices.begin (), object.seen.vertices.end ());
  const auto add = [&] (const TriangleMesh& mesh, const std::string& caption, const std::string& what) {
    if (mesh.empty ())
      return;
    pictures.push_back (pictureJson (drawFrontAndBack (mesh, fit_to, directions), caption,
                                     name + ", " + what + ", from the side of the camera above and from behind below"));
  };
  add (object.seen, "Seen", "what was seen");
  add (object.completed, "Completed", "the completed mesh");
  TriangleMesh coloured = object.completed;
  if (!coloured.provenance.empty ())
  {
    coloured.colours = provenanceColours (coloured);
    add (coloured, "By provenance", "the completed mesh in the colours of its provenance");
  }
  if (!errors_m.empty ())
  {
    coloured.colours = errorColours (errors_m, error_max_m);
    add (coloured, "Error", "the completed mesh in the colours of its distance to the true surface");
  }
  return (pictures);
}

Json
drawScenePanels (const ReportContent& content)
{
  const RunScene& scene = content.scene;
  const std::vector<double> stamps = scene.stamps ();
  const bool has_objects = std::any_of (scene.run.objects.begin (), scene.run.objects.end (),
                                        [] (const SceneRecord::Object& object) { return (!object.mesh.empty ()); });
  Json pictures = Json::array ();
  if (stamps.empty () || !has_objects)
    return (pictures);
  SceneView view;
  view.width = scene_width_px;
  view.height = scene_height_px;
  view.legend = view.caption = view.path = view.frustum = false;
  const auto add = [&] (double turn_rad, SurfaceMode surface, ColourMode colour, const std::string& caption) {
    if (surface == SurfaceMode::Tsdf && scene.tsdf.empty ())
      return;
    view.viewpoint = overview (scene, turn_rad, false);
    view.surface = surface;
    view.colour = colour;
    pictures.push_back (
        pictureJson (drawScene (scene, stamps[stamps.size () / 2], view), caption, "The scene: " + caption));
  };
  add (0.0, SurfaceMode::Tsdf, ColourMode::Real, "Seen, from the side of the camera");
  add (0.0, SurfaceMode::Completed, ColourMode::Real, "Completed, from the side of the camera");
  add (M_PI, SurfaceMode::Tsdf, ColourMode::Real, "Seen, from behind");
  add (M_PI, SurfaceMode::Completed, ColourMode::Provenance, "Completed, from behind, by provenance");
  return (pictures);
}
