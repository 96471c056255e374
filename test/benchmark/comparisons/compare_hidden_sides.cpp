// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_hidden_sides [SCENES [FIRST_SEED [PRIORS]]]: how well things on random tables, some of which hide others in
// part, are completed from one view and from two; by kind.

#include "random_table.h"
#include "thing_scores.h"

#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/simulation/simulated_scene.h>
#include <pcl/cosection/surface/co_section.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

constexpr int views = 2;
constexpr int default_scenes = 12;

void
add (CoSection& scene, std::vector<OrientedPoint>& background, std::map<int, std::vector<OrientedPoint>>& objects,
     LabelledView view)
{
  if (view.view)
    scene.addView (std::move (*view.view));
  for (auto& [label, object] : view.objects)
  {
    std::vector<OrientedPoint>& all = label == 0 ? background : objects[static_cast<int> (label)];
    all.insert (all.end (), object.points.begin (), object.points.end ());
  }
}

std::vector<ObjectResult>
complete (const fs::path& folder, int count, const CoSectionOptions& options)
{
  CoSection scene (options);
  std::vector<OrientedPoint> background;
  std::map<int, std::vector<OrientedPoint>> objects;
  for (int v = 0; v < count; ++v)
    add (scene, background, objects,
         readPcdView ((folder / "views" / ("View000" + std::to_string (v) + ".pcd")).string ()));
  scene.setBackground (std::move (background));
  for (auto& [id, points] : objects)
    scene.addObject ({id, std::move (points), {}});
  return scene.reconstruct ().objects;
}

void
print (const std::array<std::map<std::string, ThingScores>, views>& scores)
{
  std::printf ("| thing | number | mean error, 1 view | worst | mean volume error | mean error, 2 views | worst | mean "
               "volume error |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, first] : scores[0])
  {
    std::printf ("| %s | %zu |", name.c_str (), first.errors_m.size ());
    for (const auto& by_kind : scores)
    {
      const ThingScores& s = by_kind.at (name);
      std::printf (" %.2f mm | %.1f mm | %.1f %% |", 1e3 * s.meanError (), 1e3 * s.worstError (),
                   100.0 * s.meanVolumeError ());
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
  if (scenes < 1 || first < 0 || argc > 4)
  {
    std::fprintf (stderr, "Usage: compare_hidden_sides [SCENES [FIRST_SEED [PRIORS]]]\n");
    return 2;
  }
  CoSectionOptions options;
  try
  {
    options.priors = Priors::named (argc > 3 ? argv[3] : "all");
  }
  catch (const InvalidArgument& error)
  {
    std::fprintf (stderr, "compare_hidden_sides: %s\n", error.what ());
    return 2;
  }
  const fs::path folder = fs::temp_directory_path () / ("compare_hidden_sides_" + std::to_string (::getpid ()));
  std::array<std::map<std::string, ThingScores>, views> scores;
  for (int s = first; s < first + scenes; ++s)
  {
    fs::remove_all (folder);
    writeSequence (parseSceneSpec (randomTable (static_cast<unsigned> (s), views), "random table"), folder.string ());
    ReadingNotes notes;
    const SceneRecord truth = readTruth (folder.string (), notes);
    for (int v = 0; v < views; ++v)
      measureThings (truth, complete (folder, v + 1, options), scores[static_cast<std::size_t> (v)]);
  }
  fs::remove_all (folder);
  print (scores);
}
