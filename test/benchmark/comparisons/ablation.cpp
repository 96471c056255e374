// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// ablation OUTPUT [DATASET|PRESET|SPEC.json ...]: what each constraint is worth, on sequences with known poses and
// masks: folders with their truth, or simulated (all presets). Completes their objects without constraints, with each,
// and with all, lets PCL's methods reconstruct the points of the same keyframes, and compares everything with the
// truth. Prints tables and saves them in OUTPUT/ablation.md and .csv, with all meshes and a picture of each scene.

#include "ablation_picture.h"
#include "ablation_table.h"
#include "benchmark_dataset.h"
#include "rivals.h"

#include "output_files.h"

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/fusion/sequence_fusion.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/console/print.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>

using namespace pcl::cosection;
using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace {

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

using Meshes = std::map<int, TriangleMesh>;

/** \brief All objects at once, and what their TSDF volumes say; empty where it failed. */
std::pair<Meshes, Meshes>
complete (const BenchmarkDataset& data, const Variant& variant)
{
  FusionOptions options;
  CoSectionOptions& method = options.backend.method;
  const bool whole = method.whole_background;
  const std::size_t min_points = method.min_points;
  method = variant.paper ? CoSectionOptions::paper () : CoSectionOptions ();
  method.whole_background = whole;
  method.min_points = min_points;
  method.use_hull = variant.hull;
  method.use_intersection = variant.intersection;
  FusionResult result = SequenceFusion (data.known, options).run ();
  std::pair<Meshes, Meshes> meshes;
  for (ObjectResult& object : result.scene.objects)
  {
    if (!object.error.empty ())
      std::cerr << variant.name << ": object " << object.id << ": " << object.error << '\n';
    meshes.first[object.id] = std::move (object.mesh);
  }
  for (auto& [id, object] : result.objects)
    meshes.second[id] = std::move (object.tsdf);
  return meshes;
}

/** \brief The points of all keyframes, by object, in its frame. */
std::map<int, std::vector<OrientedPoint>>
keyframePoints (const BenchmarkDataset& data)
{
  const FusionOptions options;
  const auto camera = posesAtStamps (data.known.camera, data.images.stamps (), data.images.period ());
  std::map<int, std::vector<OrientedPoint>> points;
  std::vector<std::string> warnings;
  for (std::size_t n = 0; n < data.images.size (); n += static_cast<std::size_t> (options.keyframe_every))
  {
    const RgbdFrame frame = data.images.read (n, warnings);
    const auto mask = data.masks.read (frame.stamp);
    if (!camera[n] || !mask)
      continue;
    const Keyframe keyframe = makeKeyframe (frame, data.images.camera (), *mask, *camera[n], options.keyframe);
    for (const SceneRecord::Object& object : data.truth.objects)
    {
      const auto pose = posesAtStamps (object.poses, {frame.stamp}, data.images.period ()).front ();
      const auto seen = keyframe.points.find (object.id);
      if (!pose || seen == keyframe.points.end ())
        continue;
      const Eigen::Isometry3d T = pose->inverse () * *camera[n];
      for (OrientedPoint p : seen->second)
      {
        p.position = (T * p.position.cast<double> ()).cast<float> ();
        p.normal = (T.linear () * p.normal.cast<double> ()).cast<float> ();
        points[object.id].push_back (p);
      }
    }
  }
  return points;
}

AblationScene
runScene (const std::string& name, const fs::path& output)
{
  AblationScene result;
  result.name = sceneName (name);
  const fs::path folder = output / result.name;
  const BenchmarkDataset data (prepareDataset (name, folder));
  for (const std::string& warning : data.notes.warnings)
    std::cerr << result.name << ": " << warning << '\n';
  const std::map<int, std::vector<OrientedPoint>> points = keyframePoints (data);
  const auto each = [&] (TriangleMesh (*method) (const std::vector<OrientedPoint>&)) {
    Meshes meshes;
    for (const auto& [id, of] : points)
      meshes[id] = method (of);
    return meshes;
  };
  Meshes tsdf;
  std::vector<std::pair<std::string, std::function<Meshes ()>>> methods;
  methods.emplace_back (tools_of_others[0], [&] { return each (poissonSurface); });
  methods.emplace_back (tools_of_others[1], [&] { return each (convexHull); });
  methods.emplace_back (tools_of_others[2], [&] { return each (hoppeSurface); });
  for (const Variant& variant : variants)
    methods.emplace_back (variant.name, [&data, &tsdf, variant] {
      auto [completed, volumes] = complete (data, variant);
      tsdf = std::move (volumes);
      return completed;
    });
  methods.emplace_back ("TSDF", [&] { return tsdf; });

  for (const SceneRecord::Object& object : data.truth.objects)
    result.objects.push_back (object.name);
  PictureRows rows (data.truth);
  for (const auto& [method, reconstruct] : methods)
  {
    const auto start = std::chrono::steady_clock::now ();
    const Meshes meshes = reconstruct ();
    AblationRow row;
    row.method = method;
    row.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
    std::string file = method;
    std::replace_if (
        file.begin (), file.end (), [] (char c) { return c == ':' || c == ' ' || c == ',' || c == '-'; }, '_');
    fs::create_directories (folder / file);
    for (const SceneRecord::Object& object : data.truth.objects)
    {
      const auto mesh = meshes.find (object.id);
      row.results.emplace_back ();
      if (mesh == meshes.end () || mesh->second.empty ())
        continue;
      row.results.back ().comparison = compareMeshes (object.mesh, mesh->second);
      row.results.back ().closed = computeTopology (mesh->second).closed_manifold;
      saveMesh (mesh->second, (folder / file / (object.name + ".ply")).string ());
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
    std::cerr << "Usage: ablation OUTPUT [DATASET|PRESET|SPEC.json ...]\n";
    return 2;
  }
  try
  {
    pcl::console::setVerbosityLevel (pcl::console::L_ERROR);
    const fs::path output = argv[1];
    std::vector<AblationScene> scenes;
    for (const std::string& name : scenesOrPresets (argc - 2, argv + 2))
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
