// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_poses OUTPUT [DATASET|PRESET|SPEC.json ...]: what is lost where poses are not known, on sequences with their
// truth: folders, or simulated (all presets). Completes their objects with the true poses and masks of all frames, and
// again without poses, with masks of every tenth frame whose numbers change. Prints tables and saves them in
// OUTPUT/poses.md.

#include "benchmark_dataset.h"

#include "output_files.h"

#include "pcl_cosection/io/image_io.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <exception>
#include <iostream>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t mask_every = 10; // frames

/** \brief Masks of a few frames; an instance has another number in each. */
void
writeSparseMasks (const BenchmarkDataset& data, const fs::path& folder)
{
  fs::remove_all (folder);
  fs::create_directories (folder);
  const std::vector<double> stamps = data.images.stamps ();
  for (std::size_t n = 0; n < stamps.size (); n += mask_every)
  {
    auto mask = data.masks.read (stamps[n]);
    if (!mask)
      continue;
    for (std::uint16_t& pixel : mask->pixels)
      if (pixel != 0)
        pixel = static_cast<std::uint16_t> (1 + (pixel * 37 + n * 11) % 211); // differs between numbers up to 210
    saveMaskImage (*mask, (folder / (std::to_string (stamps[n]) + ".png")).string ());
  }
}

std::string
cell (const RunEvaluation& run, int truth_id)
{
  for (const ObjectEvaluation& object : run.objects)
    if (object.truth_id == truth_id)
      return format ("%.1f / %.1f / %.2f%s", 1e3 * object.mesh.comparison.accuracy.mean,
                     1e3 * object.mesh.comparison.completeness.mean, object.mesh.comparison.f_score,
                     object.mesh.estimate.topology.closed_manifold ? "" : ", open");
  return "-";
}

/** \brief The worse ratio of accuracies and completenesses. */
std::string
worseBy (const RunEvaluation& given, const RunEvaluation& tracked, int truth_id)
{
  for (const ObjectEvaluation& a : given.objects)
    for (const ObjectEvaluation& b : tracked.objects)
      if (a.truth_id == truth_id && b.truth_id == truth_id)
        return format ("%.2f", std::max (b.mesh.comparison.accuracy.mean / a.mesh.comparison.accuracy.mean,
                                         b.mesh.comparison.completeness.mean / a.mesh.comparison.completeness.mean));
  return "-";
}

std::string
trajectoryCells (const RunEvaluation& run, int truth_id)
{
  for (const ObjectEvaluation& object : run.objects)
    if (object.truth_id == truth_id)
      return format ("%.2f | %zu of %zu", 1e3 * object.trajectory.ate_m.rmse, object.frames_tracked_visible,
                     object.frames_visible);
  return "- | -";
}

std::string
runScene (const std::string& name, const fs::path& output)
{
  const fs::path folder = output / sceneName (name);
  const BenchmarkDataset data (prepareDataset (name, folder));
  for (const std::string& warning : data.notes.warnings)
    std::cerr << name << ": " << warning << '\n';
  writeSparseMasks (data, folder / "masks");
  const MaskSequence masks ((folder / "masks").string (), data.images);
  const RunEvaluation given = evaluateRun (data.truth, recordOf (SequenceFusion (data.known).run ()));
  const RunEvaluation tracked = evaluateRun (data.truth,
                                             recordOf (SequenceFusion (TrackedSequence (data.images, &masks)).run ()));

  std::string text = "### " + sceneName (name) +
                     "\n\n| accuracy / completeness (mm) / F@1cm | given | tracked | worse by | ATE, mm | frames |\n" +
                     "|---|---|---|---|---|---|\n";
  for (const SceneRecord::Object& object : data.truth.objects)
    text += "| " + object.name + " | " + cell (given, object.id) + " | " + cell (tracked, object.id) + " | " +
            worseBy (given, tracked, object.id) + " | " + trajectoryCells (tracked, object.id) + " |\n";
  text += format ("| camera | | | | %.2f | %zu of %zu |\n\n", 1e3 * tracked.camera.ate_m.rmse, tracked.camera.matched,
                  data.images.size ());
  return text;
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 2 || argv[1][0] == '-')
  {
    std::cerr << "Usage: compare_poses OUTPUT [DATASET|PRESET|SPEC.json ...]\n";
    return 2;
  }
  try
  {
    const fs::path output = argv[1];
    std::string text;
    for (const std::string& name : scenesOrPresets (argc - 2, argv + 2))
    {
      const std::string scene = runScene (name, output);
      std::cout << scene << std::flush;
      text += scene;
    }
    saveText (text, (output / "poses.md").string ());
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "compare_poses: " << error.what () << '\n';
    return 1;
  }
}
