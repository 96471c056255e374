// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_stability SCENE [SCENE ...]: how scenes rest in MuJoCo whose bodies are made from completed objects, or from
// the observed points by other means. SCENE is a labelled PCD view, or a folder with such views of one scene.

#include "command_line.h"
#include "rivals.h"
#include "scene_input.h"
#include "scene_stability.h"
#include "stability/hull_scene.h"
#include "stability/stability_row.h"

#include "pcl_cosection/physics/convex_hull_mesh.h"
#include "pcl_cosection/physics/scene_builder.h"
#include "pcl_cosection/view/outliers/point_clusters.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/co_section.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

constexpr double outlier_reach_voxels = 3.0; // as CoSection leaves them out

struct Scene
{
  std::string name;
  std::map<int, std::vector<OrientedPoint>> points; ///< of each object, without outliers
  CompletedScene completed;
};

/** \brief The views of a scene, and its name. */
std::pair<std::vector<std::string>, std::string>
viewsOf (const fs::path& path)
{
  if (!fs::is_directory (path))
    return {{path.string ()}, path.stem ().string ()};
  std::vector<std::string> views;
  for (const fs::directory_entry& entry : fs::directory_iterator (path))
    if (entry.path ().extension () == ".pcd")
      views.push_back (entry.path ().string ());
  if (views.empty ())
    throw InvalidArgument (path.string () + ": has no PCD views");
  std::sort (views.begin (), views.end ());
  return {views, (path.has_filename () ? path : path.parent_path ()).filename ().string ()};
}

/** \brief What the program pcl_cosection does by default with some views. */
Settings
defaultSettings (const std::vector<std::string>& views)
{
  std::vector<const char*> words = {"pcl_cosection"};
  for (const std::string& view : views)
    words.push_back (view.c_str ());
  words.push_back ("nowhere"); // no file is written
  Settings settings = parseCommandLine (static_cast<int> (words.size ()), words.data ()).value ();
  static const CompletionNetwork::ConstPtr network = [] {
    const std::string file = completionNetworkFile ();
    if (file.empty ())
      std::fprintf (stderr, "there is no network for the learned prior\n");
    return file.empty () ? nullptr : loadCompletionNetwork (file);
  }();
  settings.method.completion_network = network;
  return settings;
}

std::vector<OrientedPoint>
withoutOutliers (const std::vector<OrientedPoint>& points, double voxel_size_m)
{
  Eigen::AlignedBox3f box;
  for (const OrientedPoint& point : points)
    box.extend (point.position);
  const std::vector<bool> outliers = findOutlierPoints (points, box.center ().cast<double> (),
                                                        outlier_reach_voxels * voxel_size_m);
  std::vector<OrientedPoint> inliers;
  for (std::size_t p = 0; p < points.size (); ++p)
    if (!outliers[p])
      inliers.push_back (points[p]);
  return inliers;
}

Scene
complete (const std::string& path)
{
  Scene scene;
  const auto [views, name] = viewsOf (path);
  scene.name = name;
  const Settings settings = defaultSettings (views);
  SceneInput input = readScene (settings, [] (const std::string&, double) { return true; });
  CoSection method (settings.method);
  for (DepthView& view : input.views)
    method.addView (std::move (view));
  method.setBackground (std::move (input.background));
  for (const auto& [id, object] : input.objects)
  {
    scene.points[id] = object.points;
    method.addObject (object);
  }
  SceneResult result = method.reconstruct ();
  scene.completed.planes = result.planes;
  scene.completed.background = std::move (result.background);
  for (ObjectResult& object : result.objects)
  {
    if (!object.error.empty () || !object.signed_distance)
      continue;
    const double voxel_size_m = object.signed_distance->grid.voxel_size_m;
    scene.points[object.id] = withoutOutliers (scene.points[object.id], voxel_size_m);
    scene.completed.objects.push_back ({object.id, "", std::move (object.mesh), {}, voxel_size_m});
  }
  return scene;
}

using Surface = std::function<std::vector<Eigen::Vector3f> (const std::vector<OrientedPoint>&)>;

std::vector<Eigen::Vector3f>
positionsOf (const std::vector<OrientedPoint>& points)
{
  std::vector<Eigen::Vector3f> positions;
  for (const OrientedPoint& point : points)
    positions.push_back (point.position);
  return positions;
}

test::SurfacePoints
surfacesOf (const Scene& scene, const Surface& surface)
{
  test::SurfacePoints surfaces;
  for (const auto& [id, points] : scene.points)
    surfaces[id] = surface (points);
  return surfaces;
}

/** \brief What is exported if the convex hulls of the points are all that is known of the objects. */
PhysicalScene
exportOfHulls (const Scene& scene)
{
  CompletedScene hulls = scene.completed;
  for (CompletedObject& object : hulls.objects)
  {
    std::vector<Eigen::Vector3d> points;
    for (const OrientedPoint& point : scene.points.at (object.id))
      points.push_back (point.position.cast<double> ());
    object.mesh = convexHullOf (points).mesh ();
  }
  PhysicsOptions options;
  options.collision = CollisionShape::Hull;
  return buildPhysicalScene (hulls, options);
}

/** \brief The ways to make bodies, in the order of compare (). */
std::vector<StabilityRow>
emptyRows ()
{
  std::vector<StabilityRow> rows;
  for (const char* method :
       {"completed objects, exported", "convex hulls of these, as they are", "convex hulls of the points, as they are",
        "convex hulls of `pcl::Poisson`, as they are", "convex hulls of the points, exported"})
    rows.emplace_back (method);
  return rows;
}

/** \brief Make the bodies of a scene in each way, and let them move. */
void
compare (const Scene& scene, const std::string& folder, std::vector<StabilityRow>& rows)
{
  const PhysicalScene exported = buildPhysicalScene (scene.completed, {});
  for (const std::string& warning : exported.warnings)
    std::fprintf (stderr, "%s: %s\n", scene.name.c_str (), warning.c_str ());
  test::SurfacePoints completed;
  for (const CompletedObject& object : scene.completed.objects)
    completed[object.id] = object.mesh.vertices;
  const auto hullsOf = [&] (const test::SurfacePoints& points) {
    return test::sceneOfHulls (points, PhysicsOptions ().density_kg_m3, exported);
  };
  const auto poisson = [] (const auto& points) { return test::poissonSurface (points).vertices; };
  const std::vector<PhysicalScene> scenes = {exported, hullsOf (completed), hullsOf (surfacesOf (scene, positionsOf)),
                                             hullsOf (surfacesOf (scene, poisson)), exportOfHulls (scene)};
  for (std::size_t n = 0; n < scenes.size (); ++n)
    rows[n].add (scene.name, scene.points.size (), scenes[n], folder);
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 2)
  {
    std::fprintf (stderr, "Usage: compare_stability SCENE [SCENE ...]\n"
                          "SCENE is a labelled PCD view, or a folder with such views of one scene.\n");
    return 2;
  }
  const std::string folder = fs::temp_directory_path () / ("compare_stability_" + std::to_string (::getpid ()));
  try
  {
    std::vector<StabilityRow> rows = emptyRows ();
    for (int k = 1; k < argc; ++k)
      compare (complete (argv[k]), folder, rows);
    std::fputs (StabilityRow::head ().c_str (), stdout);
    for (const StabilityRow& row : rows)
      std::fputs (row.text ().c_str (), stdout);
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf (stderr, "compare_stability: %s\n", error.what ());
    fs::remove_all (folder);
    return 1;
  }
}
