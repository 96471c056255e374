// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/scene_picture.h>

#include "scene_legend.h"
#include "scene_lines.h"

#include "pcl_cosection/evaluation/pictures/picture_canvas.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour no_colour = {200, 200, 200}; ///< of readings without a colour image
constexpr TriangleMesh::Colour paper = {246, 247, 249};
constexpr double text_size = 0.5;
constexpr int margin_px = 14;
constexpr int line_px = 22;
constexpr double ambient_light = 0.35; ///< the rest comes from the head light
constexpr int other_id = 0;
constexpr double near_m = 0.02;        ///< nearer parts of lines are not drawn
constexpr double most_points = 6000.0; ///< of a line

std::unique_ptr<RgbdSequence>
openImages (const RunScene& scene, const std::string& dataset)
{
  if (scene.of_views)
    throw IoError (scene.folder + ": is made of views, not of a sequence of images: there are no points to show");
  const std::string folder = dataset.empty () ? scene.dataset : dataset;
  if (folder.empty ())
    throw IoError (
        scene.folder +
        ": does not name the images that the run has read, so there are no points to show; name them with --dataset");
  std::error_code ignored;
  if (dataset.empty () && !std::filesystem::is_directory (folder, ignored))
    throw IoError (folder +
                   ": the images that the run has read are not there any more; name their folder with --dataset");
  return std::make_unique<RgbdSequence> (folder, scene.source);
}

/** \brief A mesh in other colours. */
TriangleMesh
recoloured (const TriangleMesh& mesh, std::vector<TriangleMesh::Colour> colours)
{
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.normals = mesh.normals;
  result.triangles = mesh.triangles;
  result.colours = std::move (colours);
  return result;
}

void
removeTrianglesThatFaceAway (const Eigen::Vector3d& eye, TriangleMesh& mesh)
{
  const Eigen::Vector3f from = eye.cast<float> ();
  const auto faces_away = [&] (const TriangleMesh::Triangle& t) {
    const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    return (b - a).cross (c - a).dot (from - a) < 0.0f;
  };
  mesh.triangles.erase (std::remove_if (mesh.triangles.begin (), mesh.triangles.end (), faces_away),
                        mesh.triangles.end ());
}

/** \brief From where, and with which camera. */
struct Eye
{
  PinholeCamera camera;
  Eigen::Isometry3d T_world_camera;
};

Eye
eyeOf (const RunScene& scene, double stamp, const SceneView& view)
{
  const int width = view.width * view.oversampling, height = view.height * view.oversampling;
  if (view.viewpoint)
    return {view.viewpoint->camera (width, height), view.viewpoint->pose ()};
  const std::optional<Eigen::Isometry3d> pose = scene.cameraAt (stamp);
  if (!pose)
  {
    std::ostringstream text;
    text << "the run has no frame at " << stamp;
    throw InvalidArgument (text.str ());
  }
  return {fittedCamera (scene.camera (), width, height), *pose};
}

void
drawSurfaces (const RunScene& scene, double stamp, const SceneView& view, const Eye& eye, Rasterizer& rasterizer)
{
  if (view.background && !scene.surface (RunScene::background, view.surface).empty ())
  {
    TriangleMesh mesh = recoloured (scene.surface (RunScene::background, view.surface),
                                    surfaceColours (scene, RunScene::background, view.surface, view.colour));
    removeTrianglesThatFaceAway (eye.T_world_camera.translation (), mesh);
    rasterizer.draw (mesh, other_id);
  }
  if (!view.objects)
    return;
  for (const SceneRecord::Object& object : scene.run.objects)
  {
    const std::optional<Eigen::Isometry3d> pose = scene.poseAt (object, stamp);
    const TriangleMesh& mesh = scene.surface (object.id, view.surface);
    if (pose && !mesh.empty ())
      rasterizer.draw (recoloured (mesh, surfaceColours (scene, object.id, view.surface, view.colour)), object.id,
                       *pose);
  }
}

/** \brief Draw points of the lines, so near each other that they touch. */
void
drawLines (const std::vector<SceneLine>& lines, const Eye& eye, int size_px, Rasterizer& rasterizer)
{
  std::vector<Eigen::Vector3f> points;
  std::vector<TriangleMesh::Colour> colours;
  const Eigen::Isometry3d T_camera_world = eye.T_world_camera.inverse ();
  for (const SceneLine& line : lines)
  {
    Eigen::Vector3d a = T_camera_world * line.begin, b = T_camera_world * line.end;
    if (a.z () > b.z ())
      std::swap (a, b);
    if (b.z () <= near_m)
      continue;
    if (a.z () < near_m)
      a += (near_m - a.z ()) / (b.z () - a.z ()) * (b - a);
    // Equal steps in the picture are steps in the inverse of the depth.
    const double length_px = (eye.camera.project (b) - eye.camera.project (a)).norm ();
    const double steps = std::clamp (std::ceil (length_px), 1.0, most_points);
    for (double n = 0.0; n <= steps; ++n)
    {
      const double share = n / steps;
      const double along = share * a.z () / ((1.0 - share) * b.z () + share * a.z ());
      points.push_back ((eye.T_world_camera * (a + along * (b - a))).cast<float> ());
      colours.push_back (line.colour);
    }
  }
  rasterizer.drawPoints (points, colours, other_id, size_px);
}

/** \brief Brighter than shade (), whose dark sides hide colours. */
void
shadeOnto (const RasterImage& image, const PinholeCamera& camera, PictureCanvas::Pixels& pixels)
{
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
    {
      const std::size_t index = static_cast<std::size_t> (v) * image.width + u;
      cv::Vec3b& pixel = pixels (v, u);
      if (!std::isfinite (image.depth[index]))
      {
        pixel = cv::Vec3b (paper[0], paper[1], paper[2]);
        continue;
      }
      const Eigen::Vector3d to_camera = -camera.unproject (u, v, 1.0).normalized ();
      const double cosine = std::max (0.0, to_camera.dot (image.normals[index].cast<double> ()));
      const double light = std::min (1.0, ambient_light + (1.0 - ambient_light) * cosine);
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] = static_cast<std::uint8_t> (std::lround (light * image.colours[index][channel]));
    }
}

void
drawLegend (const ColourLegend& legend, const SceneView& view, PictureCanvas& canvas)
{
  if (legend.hasScale ())
  {
    constexpr int bar_px = 22, column_px = 104;
    const int height = std::min (260, view.height / 2);
    const cv::Rect bar (view.width - column_px, (view.height - height) / 2, bar_px, height);
    canvas.veil (cv::Rect (bar.x - margin_px, bar.y - 2 * line_px, column_px + margin_px, height + 3 * line_px));
    canvas.drawScale (bar, {{legend.title}, legend.least, legend.most, legend.more, legend.most < legend.least});
    return;
  }
  if (legend.entries.empty ())
    return;
  constexpr int swatch_px = 14;
  int width = 0;
  for (const LegendEntry& entry : legend.entries)
    width = std::max (width, canvas.widthOf (entry.text, text_size));
  const std::size_t most = static_cast<std::size_t> (std::max (1, (view.height - 4 * margin_px) / line_px));
  const int count = static_cast<int> (std::min (most, legend.entries.size ()));
  const int left = view.width - width - swatch_px - 3 * margin_px;
  canvas.veil (cv::Rect (left, margin_px, view.width - left - margin_px, count * line_px + margin_px));
  for (int n = 0; n < count; ++n)
  {
    const int top = 2 * margin_px + n * line_px - margin_px / 2;
    const LegendEntry& entry = legend.entries[static_cast<std::size_t> (n)];
    canvas.fill (cv::Rect (left + margin_px / 2, top, swatch_px, swatch_px), entry.colour);
    canvas.write (entry.text, left + swatch_px + margin_px, top + swatch_px - 2, text_size);
  }
}

void
drawCaption (const std::string& text, const SceneView& view, PictureCanvas& canvas)
{
  const int width = canvas.widthOf (text, text_size);
  canvas.veil (cv::Rect (margin_px, view.height - margin_px - line_px - 4, width + margin_px, line_px + 4));
  canvas.write (text, margin_px + margin_px / 2, view.height - margin_px - 8, text_size);
}

} // namespace

FramePointReader::FramePointReader (const RunScene& scene, const std::string& dataset)
    : images_ (openImages (scene, dataset))
    , stamps_ (images_->stamps ())
{}

FramePointReader::~FramePointReader () = default;
FramePointReader::FramePointReader (FramePointReader&&) noexcept = default;
FramePointReader& FramePointReader::operator= (FramePointReader&&) noexcept = default;

FramePoints
FramePointReader::read (const RunScene& scene, double stamp, int every) const
{
  if (every < 1)
    throw InvalidArgument ("every must be at least 1 pixel");
  FramePoints result;
  const std::optional<Eigen::Isometry3d> T_world_camera = scene.cameraAt (stamp);
  const std::optional<std::size_t> index = nearestStamp (stamps_, stamp, 0.5 * images_->period ());
  if (!index || !T_world_camera)
    return result;
  std::vector<std::string> ignored;
  const RgbdFrame frame = images_->read (*index, ignored);
  const PinholeCamera& camera = images_->camera ();
  for (int v = 0; v < camera.height; v += every)
    for (int u = 0; u < camera.width; u += every)
    {
      const float z = frame.depth.at (u, v);
      if (!std::isfinite (z))
        continue;
      result.points.push_back ((*T_world_camera * camera.unproject (u, v, z)).cast<float> ());
      result.colours.push_back (frame.colour.pixels.empty () ? no_colour : frame.colour.at (u, v));
    }
  return result;
}

void
SceneView::validate () const
{
  constexpr int least_px = 64, most_px = 8192, most_oversampling = 4;
  if (width < least_px || width > most_px || height < least_px || height > most_px)
    throw InvalidArgument ("the picture must be from 64 to 8192 pixels wide and high");
  if (oversampling < 1 || oversampling > most_oversampling)
    throw InvalidArgument ("oversampling must be from 1 to 4");
  if (viewpoint)
    viewpoint->validate ();
}

Picture
drawScene (const RunScene& scene, double stamp, const SceneView& view, const FramePoints* points)
{
  view.validate ();
  const Eye eye = eyeOf (scene, stamp, view);
  Rasterizer rasterizer (eye.camera, eye.T_world_camera);
  drawSurfaces (scene, stamp, view, eye, rasterizer);
  if (points && view.surface == SurfaceMode::Points)
    rasterizer.drawPoints (points->points, points->colours, other_id, view.oversampling + 1);
  drawLines (linesOf (scene, stamp, view), eye, view.oversampling + 1, rasterizer);

  PictureCanvas canvas (view.width, view.height, view.oversampling);
  shadeOnto (rasterizer.image (), eye.camera, canvas.pixels ());
  if (view.legend && view.surface != SurfaceMode::Points)
    drawLegend (legendOf (scene, view.colour), view, canvas);
  if (view.caption)
    drawCaption (sceneCaption (scene, stamp, view.surface, view.colour), view, canvas);
  return canvas.picture ();
}

} // namespace pcl::cosection
