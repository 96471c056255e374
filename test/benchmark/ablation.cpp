// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// ablation OUTPUT [PRESET|SPEC.json ...]: what each constraint is worth. Simulates views of known scenes (all presets), completes
// their objects without constraints, with each, and with all, lets PCL's methods reconstruct the same points, and
// compares everything with the truth. Prints tables and saves them in OUTPUT/ablation.md and .csv, with all meshes and a
// picture of each scene. Poses are known, depth is noisy.

#include "ablation_picture.h"
#include "ablation_table.h"
#include "rivals.h"

#include "output_files.h"
#include "scene_input.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/rendering/picture.h>
#include <pcl/cosection/simulation/scene_spec.h>
#include <pcl/cosection/simulation/sequence_writer.h>
#include <pcl/cosection/surface/co_section.h>

#include <pcl/console/print.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>

using namespace pcl::cosection;
using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace
{

const char* const tools_of_others[] = {"pcl::Poisson", "pcl::ConvexHull", "pcl::MarchingCubesHoppe"};

struct Variant
{
  const char* name;
  bool hull, intersection, paper;
};

constexpr Variant variants[] = {{"none", false, false, false},
                                {"hull", true, false, false},
                                {"intersection", false, true, false},
                                {"all", true, true, false},
                                {"all, --preset paper", true, true, true}};

SimulatedScene
sceneOf (const std::string& name)
{
  for (const ScenePreset& preset : scenePresets ())
    if (preset.name == name)
      return parseSceneSpec (preset.spec, name);
  return loadSceneSpec (name);
}

/** \brief The scene as only its views: each frame is one. */
SimulatedScene
viewsOnly (SimulatedScene scene)
{
  if (scene.views_every < 1)
    throw InvalidArgument ("the scene has no views; give it \"views\": {\"every\": N}");
  scene.frames = (scene.frames - 1) / scene.views_every + 1;
  scene.rate /= scene.views_every;
  scene.views_every = 1;
  return scene;
}

Settings
settingsFor (const SimulatedScene& scene, const fs::path& data)
{
  Settings settings;
  for (int view = 0; view < scene.frames; ++view)
  {
    char name[32];
    std::snprintf (name, sizeof name, "View%04d.pcd", view);
    settings.inputs.push_back ((data / "views" / name).string ());
  }
  for (const SceneBody& body : scene.bodies)
    if (body.id > 0)
      settings.object_trajectories[body.id] =
          (data / "views" / ("gt-" + body.name + "-" + std::to_string (body.id) + ".txt")).string ();
  return settings;
}

/** \brief Complete all objects at once. \return by id; empty where it failed */
std::map<int, TriangleMesh>
complete (const SceneInput& input, const Variant& variant)
{
  CoSectionOptions options = variant.paper ? CoSectionOptions::paper () : CoSectionOptions ();
  options.use_hull = variant.hull;
  options.use_intersection = variant.intersection;
  CoSection task (options);
  for (const DepthView& view : input.views)
    task.addView (view);
  if (!input.background.empty ())
    task.setBackground (input.background);
  for (const auto& [id, object] : input.objects)
    task.addObject (object);
  std::map<int, TriangleMesh> meshes;
  for (ObjectResult& object : task.reconstruct ().objects)
  {
    if (!object.error.empty ())
      std::cerr << variant.name << ": object " << object.id << ": " << object.error << '\n';
    meshes[object.id] = std::move (object.mesh);
  }
  return meshes;
}

std::map<int, TriangleMesh>
reconstructEach (const SceneInput& input, const std::function<TriangleMesh (const std::vector<OrientedPoint>&)>& method)
{
  std::map<int, TriangleMesh> meshes;
  for (const auto& [id, object] : input.objects)
    meshes[id] = method (object.points);
  return meshes;
}

AblationScene
runScene (const std::string& name, const fs::path& output)
{
  const SimulatedScene scene = viewsOnly (sceneOf (name));
  AblationScene result;
  result.name = fs::path (name).stem ().string ();
  const fs::path folder = output / result.name;
  fs::remove_all (folder / "data");
  writeSequence (scene, (folder / "data").string ());
  const SceneInput input = readScene (settingsFor (scene, folder / "data"), [] (const std::string&, double) { return true; });
  for (const std::string& warning : input.warnings)
    std::cerr << result.name << ": " << warning << '\n';

  std::vector<std::pair<std::string, std::function<std::map<int, TriangleMesh> ()>>> methods;
  methods.emplace_back (tools_of_others[0], [&] { return reconstructEach (input, poissonSurface); });
  methods.emplace_back (tools_of_others[1], [&] { return reconstructEach (input, convexHull); });
  methods.emplace_back (tools_of_others[2], [&] { return reconstructEach (input, hoppeSurface); });
  for (const Variant& variant : variants)
    methods.emplace_back (variant.name, [&input, variant] { return complete (input, variant); });

  std::map<int, TriangleMesh> truth;
  for (const SceneBody& body : scene.bodies)
    if (body.id > 0)
    {
      truth[body.id] = loadPlyMesh ((folder / "data" / "gt-mesh" / (body.name + ".ply")).string ());
      result.objects.push_back (body.name);
    }
  PictureRows rows (truth, scene);
  for (const auto& [method, reconstruct] : methods)
  {
    const auto start = std::chrono::steady_clock::now ();
    const std::map<int, TriangleMesh> meshes = reconstruct ();
    AblationRow row;
    row.method = method;
    row.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
    std::string file = method;
    std::replace_if (file.begin (), file.end (), [] (char c) { return c == ':' || c == ' ' || c == ',' || c == '-'; }, '_');
    fs::create_directories (folder / file);
    for (const SceneBody& body : scene.bodies)
    {
      if (body.id == 0)
        continue;
      const auto mesh = meshes.find (body.id);
      row.results.emplace_back ();
      if (mesh == meshes.end () || mesh->second.empty ())
        continue;
      row.results.back ().comparison = compareMeshes (truth.at (body.id), mesh->second);
      row.results.back ().closed = computeTopology (mesh->second).closed_manifold;
      saveMesh (mesh->second, (folder / file / (body.name + ".ply")).string ());
    }
    rows.add (method, meshes);
    std::cerr << result.name << ", " << method << ": " << row.seconds << " s\n";
    result.rows.push_back (row);
  }
  writePng (rows.picture (), (output / (result.name + ".png")).string ());
  return result;
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 2 || argv[1][0] == '-')
  {
    std::cerr << "Usage: ablation OUTPUT [PRESET|SPEC.json ...]\n";
    return 2;
  }
  try
  {
    pcl::console::setVerbosityLevel (pcl::console::L_ERROR);
    const fs::path output = argv[1];
    std::vector<std::string> names (argv + 2, argv + argc);
    if (names.empty ())
      for (const ScenePreset& preset : scenePresets ())
        names.push_back (preset.name);
    std::vector<AblationScene> scenes;
    for (const std::string& name : names)
      scenes.push_back (runScene (name, output));
    const std::string table = markdown (scenes);
    std::cout << table;
    saveText (table, (output / "ablation.md").string ());
    saveText (csv (scenes), (output / "ablation.csv").string ());
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "ablation: " << error.what () << '\n';
    return 1;
  }
}
