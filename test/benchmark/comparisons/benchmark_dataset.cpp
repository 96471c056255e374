// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "benchmark_dataset.h"

#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

SimulatedScene
sceneOf (const std::string& name)
{
  for (const ScenePreset& preset : scenePresets ())
    if (preset.name == name)
      return parseSceneSpec (preset.spec, name);
  return loadSceneSpec (name);
}

} // namespace

BenchmarkDataset::BenchmarkDataset (const std::string& folder)
    : truth (readTruth (folder, notes))
    , images (folder)
    , masks (folder + "/mask", images)
{
  truth.objects.erase (std::remove_if (truth.objects.begin (), truth.objects.end (),
                                       [] (const SceneRecord::Object& object) { return object.mesh.empty (); }),
                       truth.objects.end ());
  known.images = &images;
  known.masks = &masks;
  known.camera = truth.camera;
  for (const SceneRecord::Object& object : truth.objects)
    known.objects[object.id] = object.poses;
}

std::string
sceneName (const std::string& name)
{
  const fs::path path = fs::path (name).has_filename () ? fs::path (name) : fs::path (name).parent_path ();
  return path.stem ().string ();
}

std::vector<std::string>
scenesOrPresets (int argc, const char* const* argv)
{
  std::vector<std::string> names (argv, argv + argc);
  if (names.empty ())
    for (const ScenePreset& preset : scenePresets ())
      names.push_back (preset.name);
  return names;
}

std::string
prepareDataset (const std::string& name, const fs::path& folder)
{
  if (fs::is_directory (name))
    return name;
  const SimulatedScene scene = sceneOf (name);
  fs::remove_all (folder / "data");
  writeSequence (scene, (folder / "data").string ());
  return (folder / "data").string ();
}

SceneRecord
recordOf (FusionResult result)
{
  SceneRecord record;
  record.camera = result.camera;
  record.background = std::move (result.scene.background);
  for (ObjectResult& object : result.scene.objects)
    record.objects.push_back (
        {object.id, std::to_string (object.id), result.objects[object.id].trajectory, std::move (object.mesh)});
  return record;
}

std::string
format (const char* text, ...)
{
  char line[256];
  std::va_list values;
  va_start (values, text);
  std::vsnprintf (line, sizeof line, text, values);
  va_end (values);
  return line;
}
