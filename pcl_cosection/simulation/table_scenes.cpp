// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_scenes.h"

#include "new_folder.h"
#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/common/require.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/view/organized_cloud.h"
#include "random_numbers.h"
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/rendering/rasterizer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

const PinholeCamera camera{640, 480, 570.0, 570.0, 319.5, 239.5}; // of the PrimeSense sensors
constexpr double gap_m = 0.005;                                   // between the circles around things
constexpr double table_m = 1.4;                                   // its longer side
constexpr double tiny_m = 0.005;                                  // less can hardly be seen
constexpr int tries = 3000;                                       // places for each thing

bool
isMeshFile (const fs::path& file)
{
  static const std::set<std::string> extensions = {".ply", ".obj", ".stl", ".off", ".vtk", ".vtp"};
  return extensions.count (lowerCaseExtension (file.string ())) != 0;
}

void
addBox (const Eigen::Vector3d& low, const Eigen::Vector3d& high, TriangleMesh& room)
{
  const Eigen::Isometry3d T (Eigen::Translation3d (0.5 * (low + high)));
  appendMesh (room, transformMesh (makeBox (high - low)->tessellate (0.001), T));
}

/** \brief A camera that looks at the middle of the table, 5 cm above it. */
Eigen::Isometry3d
cameraAt (double azimuth, const TableSceneOptions& options)
{
  const Eigen::Vector3d eye (options.camera_distance_m * std::sin (azimuth),
                             -options.camera_distance_m * std::cos (azimuth), options.camera_height_m);
  // Upwards in the picture, also where the camera looks straight down.
  const Eigen::Vector3d away (-std::sin (azimuth), std::cos (azimuth), 0.0);
  const Eigen::Vector3d target (0.0, 0.0, 0.05);
  return lookAt (eye, target, (eye.z () - target.z ()) * away + options.camera_distance_m * Eigen::Vector3d::UnitZ ());
}

/** \brief Refuse what is larger than the table, and warn of what is tiny. */
void
checkThing (const TriangleMesh& mesh, const std::string& path, std::vector<std::string>& warnings)
{
  Eigen::AlignedBox3d box;
  for (const auto& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  const double length_m = box.sizes ().maxCoeff ();
  std::ostringstream text;
  text.precision (3);
  text << path << ": is " << length_m << " m long; ";
  if (length_m > table_m)
    throw InvalidArgument (text.str () + "the table has 1.4 m: meshes must be in metres");
  if (length_m < tiny_m)
    warnings.push_back (text.str () + "is it in metres?");
}

/** \brief Turned about z, its middle over the origin, its lowest point on the table. */
TriangleMesh
standing (const TriangleMesh& mesh, double angle)
{
  TriangleMesh turned = transformMesh (mesh, Eigen::Isometry3d (Eigen::AngleAxisd (angle, Eigen::Vector3d::UnitZ ())));
  Eigen::AlignedBox3d box;
  for (const auto& vertex : turned.vertices)
    box.extend (vertex.cast<double> ());
  const Eigen::Vector3d foot (box.center ().x (), box.center ().y (), box.min ().z ());
  return transformMesh (std::move (turned), Eigen::Isometry3d (Eigen::Translation3d (-foot)));
}

double
radiusOf (const TriangleMesh& mesh)
{
  double radius = 0.0;
  for (const auto& vertex : mesh.vertices)
    radius = std::max (radius, static_cast<double> (vertex.head<2> ().norm ()));
  return radius;
}

/** \brief Add a post beside a thing, on the side of the first camera, so high that it hides the thing up to some
 * height; none if other things leave no room there. */
void
addPost (RandomNumbers& random, const std::vector<std::pair<Eigen::Vector2d, double>>& circles, TableScene& scene)
{
  const Eigen::Vector3d eye = scene.cameras.front ().translation ();
  for (int n = 0; n < tries; ++n)
  {
    const auto which = std::min (static_cast<std::size_t> (random.in (0.0, static_cast<double> (circles.size ()))),
                                 circles.size () - 1);
    const auto& [middle, radius] = circles[which];
    const Eigen::Vector2d to_eye = eye.head<2> () - middle;
    const double half_width = random.in (0.005, 0.02), aside = random.in (-1.0, 1.0), before_m = random.in (0.0, 0.05);
    const double hidden = random.in (0.2, 0.8); // of the thing's height
    if (to_eye.norm () < 2.0 * radius)          // from above nothing stands before it
      continue;
    const Eigen::Vector2d direction = to_eye.normalized (), across (-direction.y (), direction.x ());
    const double away_m = radius + M_SQRT2 * half_width + gap_m + before_m;
    const Eigen::Vector2d place = middle + away_m * direction + 0.5 * aside * radius * across;
    const bool is_free = std::all_of (circles.begin (), circles.end (), [&] (const auto& circle) {
      return (place - circle.first).norm () > circle.second + M_SQRT2 * half_width;
    });
    double top_m = 0.0;
    for (const auto& vertex : scene.things[which].vertices)
      top_m = std::max (top_m, static_cast<double> (vertex.z ()));
    const double height = hidden * top_m +
                          (eye.z () - hidden * top_m) * away_m / to_eye.norm (); // on the line of sight
    if (!is_free || !(height < eye.z ()))
      continue;
    addBox ({place.x () - half_width, place.y () - half_width, 0.0},
            {place.x () + half_width, place.y () + half_width, height}, scene.room);
    return;
  }
}

/** \return which things have readings */
std::vector<bool>
writeView (const TableScene& scene, int view, std::uint64_t seed, const TableSceneOptions& options,
           const std::string& path)
{
  Rasterizer rasterizer (camera, scene.cameras[view]);
  rasterizer.draw (scene.room, 0);
  for (std::size_t n = 0; n < scene.things.size (); ++n)
    rasterizer.draw (scene.things[n], static_cast<int> (n + 1));
  const RasterImage& image = rasterizer.image ();
  Image<float> depth (camera.width, camera.height);
  depth.pixels = image.depth;
  if (options.noise)
    depth = measureDepth (depth, image.normals, camera, DepthNoise (), seed, static_cast<std::uint64_t> (view));
  Image<std::uint16_t> labels (camera.width, camera.height, 0);
  std::transform (image.ids.begin (), image.ids.end (), labels.pixels.begin (),
                  [] (std::int32_t id) { return static_cast<std::uint16_t> (std::max (id, 0)); });
  std::vector<bool> is_seen (scene.things.size (), false);
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (labels.pixels[n] > 0 && std::isfinite (depth.pixels[n]))
      is_seen[labels.pixels[n] - 1] = true;
  saveLabelledCloud ({camera, depth.pixels, scene.cameras[view]},
                     withMaskErrors (std::move (labels), options.mask_dilation_px, options.mask_shift_px),
                     shade (image, camera), path);
  return is_seen;
}

} // namespace

Image<std::uint16_t>
withMaskErrors (Image<std::uint16_t> labels, int dilation_px, int shift_px)
{
  for (int step = 0; step < std::abs (dilation_px); ++step)
  {
    const Image<std::uint16_t> before = labels;
    for (int v = 0; v < labels.height; ++v)
      for (int u = 0; u < labels.width; ++u)
        for (const auto& [x, y] :
             {std::pair (u - 1, v), std::pair (u + 1, v), std::pair (u, v - 1), std::pair (u, v + 1)})
        {
          if (x < 0 || y < 0 || x >= labels.width || y >= labels.height)
            continue;
          if (dilation_px > 0 && labels.at (u, v) == 0)
            labels.at (u, v) = before.at (x, y);
          else if (dilation_px < 0 && before.at (x, y) != before.at (u, v))
            labels.at (u, v) = 0;
        }
  }
  if (shift_px == 0)
    return labels;
  Image<std::uint16_t> shifted (labels.width, labels.height, 0);
  for (int v = 0; v < labels.height; ++v)
    for (int u = 0; u < labels.width; ++u)
      if (const int from = u - shift_px; from >= 0 && from < labels.width)
        shifted.at (u, v) = labels.at (from, v);
  return shifted;
}

void
TableSceneOptions::validate () const
{
  require (scenes >= 0 && scenes <= 100000, "scenes must be 0 to 100000");
  require (per_scene >= 1 && per_scene <= 1000, "per_scene must be 1 to 1000");
  require (views >= 1 && views <= 1000, "views must be 1 to 1000");
  require (isPositive (camera_height_m), "camera_height_m must be a positive length");
  require (std::isfinite (camera_distance_m) && camera_distance_m >= 0.0,
           "camera_distance_m must be a length that is not negative");
  require (std::abs (mask_dilation_px) <= 100, "mask_dilation_px must be -100 to 100");
  require (std::abs (mask_shift_px) <= 100, "mask_shift_px must be -100 to 100");
  require (occluders >= 0 && occluders <= 100, "occluders must be 0 to 100");
}

TableScene
makeTableScene (const std::vector<std::string>& names, const std::vector<TriangleMesh>& meshes, int scene,
                const TableSceneOptions& options)
{
  options.validate ();
  std::vector<std::size_t> order (meshes.size ());
  std::iota (order.begin (), order.end (), 0);
  if (options.per_scene > 1)
    order = RandomNumbers (options.seed).permutation (meshes.size ());
  RandomNumbers random (options.seed * 1000003u + static_cast<std::uint64_t> (scene) + 1u);

  TableScene result;
  addBox ({-0.5 * table_m, -0.5, -0.03}, {0.5 * table_m, 0.5, 0.0}, result.room);
  addBox ({-2.0, -2.0, -0.75}, {2.0, 1.5, -0.7}, result.room); // floor
  addBox ({-2.0, 1.4, -0.7}, {2.0, 1.5, 2.0}, result.room);    // wall
  std::vector<std::pair<Eigen::Vector2d, double>> circles;
  for (int k = 0; k < options.per_scene; ++k)
  {
    const std::size_t which = order[(static_cast<std::size_t> (scene) * options.per_scene + k) % order.size ()];
    const TriangleMesh thing = standing (meshes[which], random.in (0.0, 2.0 * M_PI));
    const double radius = radiusOf (thing);
    Eigen::Vector2d place = Eigen::Vector2d::Zero ();
    const auto isFree = [&] {
      return std::all_of (circles.begin (), circles.end (), [&] (const auto& circle) {
        return (place - circle.first).norm () > radius + circle.second + gap_m;
      });
    };
    for (int n = 0; options.per_scene > 1 && (n == 0 || !isFree ()); ++n)
    {
      if (n == tries)
        throw InvalidArgument ("there is no room for " + std::to_string (options.per_scene) +
                               " things on the table; take less per scene, or smaller ones");
      place = {random.in (-0.28, 0.28), random.in (-0.22, 0.25)};
    }
    circles.emplace_back (place, radius);
    result.names.push_back (names[which]);
    result.things.push_back (
        transformMesh (thing, Eigen::Isometry3d (Eigen::Translation3d (place.x (), place.y (), 0.0))));
  }

  const double first = random.in (-0.3, 0.3);
  for (int view = 0; view < options.views; ++view)
    result.cameras.push_back (cameraAt (first + view * 2.0 * M_PI / options.views, options));
  for (int k = 0; k < options.occluders; ++k)
    addPost (random, circles, result);
  return result;
}

int
writeTableScenes (const std::string& folder, const std::string& output, const TableSceneOptions& options,
                  std::vector<std::string>& warnings, const ProgressCallback& progress)
{
  options.validate ();
  std::vector<fs::path> files;
  try
  {
    for (const auto& entry : fs::directory_iterator (folder))
      if (entry.is_regular_file () && isMeshFile (entry.path ()))
        files.push_back (entry.path ());
  }
  catch (const fs::filesystem_error& error)
  {
    throw IoError (folder + ": cannot be read: " + error.code ().message ());
  }
  if (files.empty ())
    throw IoError (folder + ": holds no meshes");
  std::sort (files.begin (), files.end ());
  std::vector<std::string> names;
  std::vector<TriangleMesh> meshes;
  std::vector<std::string> open;
  for (const fs::path& file : files)
  {
    names.push_back (file.stem ().string ());
    meshes.push_back (loadMesh (file.string ()));
    if (meshes.back ().triangles.empty ())
      throw IoError (file.string () + ": has no triangles");
    checkThing (meshes.back (), file.string (), warnings);
    if (!computeTopology (meshes.back ()).closed_manifold)
      open.push_back (file.string ());
  }
  if (!open.empty ())
    warnings.push_back (firstAndMore (open) + ": not closed; evaluations have no volume of such a truth");

  const int per_scene = options.per_scene;
  const int scenes = options.scenes > 0 ? options.scenes
                                        : (static_cast<int> (meshes.size ()) + per_scene - 1) / per_scene;
  NewFolder written (output);
  written.fill ([&] {
    for (int s = 0; s < scenes; ++s)
    {
      if (progress && !progress ("scenes", static_cast<double> (s) / scenes))
        throw Cancelled ("cancelled");
      const TableScene scene = makeTableScene (names, meshes, s, options);
      char name[16];
      std::snprintf (name, sizeof name, "%03d", s);
      written.makeFolder (name);
      const std::string within = std::string (name) + "/";
      std::ostringstream list;
      for (std::size_t n = 0; n < scene.things.size (); ++n)
      {
        list << n + 1 << ' ' << scene.names[n] << '\n';
        saveMesh (scene.things[n], written.file (within + "truth_" + std::to_string (n + 1) + ".ply"));
      }
      written.writeText (within + "names.txt", list.str ());
      const std::uint64_t seed = options.seed * 1000003u + static_cast<std::uint64_t> (s);
      for (int view = 0; view < options.views; ++view)
      {
        const std::string file = "view" + std::to_string (view) + ".pcd";
        const std::vector<bool> is_seen = writeView (scene, view, seed, options, written.file (within + file));
        for (std::size_t n = 0; n < is_seen.size (); ++n)
          if (!is_seen[n])
            warnings.push_back (within + file + ": shows nothing of " + scene.names[n] + ", label " +
                                std::to_string (n + 1));
      }
    }
  });
  return scenes;
}

} // namespace pcl::cosection
