// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// compare_hidden_sides [SCENES [FIRST_SEED]]: how well things on random tables, some of which hide others in part, are completed from one view
// and from two; by kind.

#include "random_table.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/evaluation/scene_folders.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/simulation/scene_spec.h>
#include <pcl/cosection/simulation/sequence_writer.h>
#include <pcl/cosection/surface/co_section.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace
{

constexpr int views = 2;
constexpr int default_scenes = 12;

struct Scores
{
  std::vector<double> errors_m; // mean of accuracy and completeness
  std::vector<double> volumes;  // of the true one
};

void
add (CoSection& scene, std::vector<OrientedPoint>& background, std::map<int, std::vector<OrientedPoint>>& objects, LabelledView view)
{
  if (view.view)
    scene.addView (std::move (*view.view));
  for (auto& [label, object] : view.objects)
  {
    std::vector<OrientedPoint>& all = label == 0 ? background : objects[static_cast<int> (label)];
    all.insert (all.end (), object.points.begin (), object.points.end ());
  }
}

SceneResult
complete (const fs::path& folder, int count)
{
  CoSection scene;
  std::vector<OrientedPoint> background;
  std::map<int, std::vector<OrientedPoint>> objects;
  for (int v = 0; v < count; ++v)
    add (scene, background, objects, readPcdView ((folder / "views" / ("View000" + std::to_string (v) + ".pcd")).string ()));
  scene.setBackground (std::move (background));
  for (auto& [id, points] : objects)
    scene.addObject ({id, std::move (points), {}});
  return scene.reconstruct ();
}

void
measure (const SceneRecord& truth, const SceneResult& result, std::map<std::string, Scores>& scores)
{
  for (const SceneRecord::Object& object : truth.objects)
  {
    const auto mesh = std::find_if (result.objects.begin (), result.objects.end (), [&] (const ObjectResult& r) { return r.id == object.id; });
    if (mesh == result.objects.end () || mesh->mesh.empty () || object.mesh.empty ())
    {
      std::printf ("no mesh of %s\n", object.name.c_str ());
      continue;
    }
    const TriangleMesh true_mesh = transformMesh (object.mesh, object.poses.front ().pose);
    const MeshComparison comparison = compareMeshes (true_mesh, mesh->mesh);
    for (const std::string& row : {object.name, std::string ("all")})
    {
      scores[row].errors_m.push_back (0.5 * (comparison.accuracy.mean + comparison.completeness.mean));
      scores[row].volumes.push_back (computeMassProperties (mesh->mesh).volume_m3 / computeMassProperties (true_mesh).volume_m3);
    }
  }
}

void
print (const std::array<std::map<std::string, Scores>, views>& scores)
{
  std::printf ("| thing | number | mean error, 1 view | worst | mean volume error | mean error, 2 views | worst | mean volume error |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, first] : scores[0])
  {
    std::printf ("| %s | %zu |", name.c_str (), first.errors_m.size ());
    for (const auto& by_kind : scores)
    {
      const Scores& s = by_kind.at (name);
      double error = 0.0, volume = 0.0;
      const auto count = static_cast<double> (s.errors_m.size ());
      for (std::size_t n = 0; n < s.errors_m.size (); ++n)
      {
        error += s.errors_m[n] / count;
        volume += std::abs (s.volumes[n] - 1.0) / count;
      }
      std::printf (" %.2f mm | %.1f mm | %.1f %% |", 1e3 * error, 1e3 * *std::max_element (s.errors_m.begin (), s.errors_m.end ()), 100.0 * volume);
    }
    std::printf ("\n");
  }
}

} // namespace

int
main (int argc, char** argv)
{
  const int scenes = argc > 1 ? std::atoi (argv[1]) : default_scenes;
  const int first = argc > 2 ? std::atoi (argv[2]) : 0;
  if (scenes < 1 || first < 0 || argc > 3)
  {
    std::fprintf (stderr, "Usage: compare_hidden_sides [SCENES [FIRST_SEED]]\n");
    return 2;
  }
  const fs::path folder = fs::temp_directory_path () / ("compare_hidden_sides_" + std::to_string (::getpid ()));
  std::array<std::map<std::string, Scores>, views> scores;
  for (int s = first; s < first + scenes; ++s)
  {
    fs::remove_all (folder);
    writeSequence (parseSceneSpec (randomTable (static_cast<unsigned> (s), views), "random table"), folder.string ());
    ReadingNotes notes;
    const SceneRecord truth = readTruth (folder.string (), notes);
    for (int v = 0; v < views; ++v)
      measure (truth, complete (folder, v + 1), scores[static_cast<std::size_t> (v)]);
  }
  fs::remove_all (folder);
  print (scores);
}
