// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_command.h"

#include "arguments.h"
#include "evaluation_text.h"
#include "failure_json.h"
#include "option_values.h"
#include "output_files.h"
#include "run_report.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <limits>

using namespace pcl::cosection;

namespace {

RunOptions
runOptions (const RunSettings& settings)
{
  RunOptions options;
  options.comparison.samples = static_cast<std::size_t> (settings.samples);
  options.comparison.seed = settings.seed;
  options.comparison.f_threshold_m = settings.f_threshold_m;
  options.trajectory = trajectoryOptions (settings.trajectory);
  options.penetration.voxel_size_m = settings.penetration_voxel_m;
  options.penetration.seed = settings.seed;
  options.refine = settings.refine != "none";
  options.threads = settings.trajectory.common.threads.value_or (0);
  return (options);
}

/** \return whether every file that is there could be read */
bool
evaluate (const RunSettings& settings, Terminal& terminal)
{
  const CommonOptions& common = settings.trajectory.common;
  ReadingNotes notes;
  const SceneRecord estimate = readRun (common.paths[0], notes);
  const SceneRecord truth = readTruth (common.paths[1], notes);
  RunEvaluation result = evaluateRun (truth, estimate, runOptions (settings));
  result.warnings.insert (result.warnings.begin (), notes.warnings.begin (), notes.warnings.end ());
  for (const std::string& warning : result.warnings)
    terminal.warning (warning);
  print (result, truth, settings, terminal);
  if (!common.json.empty ())
    saveJson (runJson (result, truth, settings), common.json);
  if (!common.csv.empty ())
    saveText (runCsv (result), common.csv);
  return (notes.whole);
}

} // namespace

void
declareRunOptions (CLI::App& app, RunSettings& settings)
{
  const std::string group = "Meshes";
  constexpr double unlimited = std::numeric_limits<double>::max ();
  app.add_option ("--samples", settings.samples, "Points on each mesh" + byDefault (settings.samples))
      ->option_text ("N")
      ->check (wholeRange (1, 100000000))
      ->group (group);
  app.add_option ("--seed", settings.seed, "Of the points: the same seed, the same points" + byDefault (0))
      ->option_text ("N")
      ->check (wholeRange (0, std::numeric_limits<long>::max ()))
      ->group (group);
  app.add_option ("--f-threshold", settings.f_threshold_m,
                  "Distance up to which a point counts for precision, recall and F-score" +
                      byDefault (settings.f_threshold_m))
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--refine", settings.refine,
                  "Refine the alignment of each object on its observed surface, by at most 2 cm and 5.7 degrees "
                  "(default: observed)")
      ->option_text ("observed|none")
      ->check (CLI::IsMember (std::vector<std::string>{"observed", "none"}))
      ->group (group);
  app.add_option ("--penetration-voxel", settings.penetration_voxel_m,
                  "Voxels of the volume of penetration (default: 1/64 of the smaller box)")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  declareComparisonOptions (app, settings.trajectory);
  declareCommonOptions (app, settings.trajectory.common);
}

void
runRunCommand (int argc, const char* const* argv, Terminal& terminal)
{
  CLI::App app;
  RunSettings settings;
  declareRunOptions (app, settings);
  if (!parseArguments (app, runText (), argc, argv))
    return;
  const CommonOptions& common = settings.trajectory.common;
  checkCommonOptions (common, "OUTPUT", "DATASET");
  refuseToOverwrite (common.paths, {common.json, common.csv});
  terminal.setVerbosity (verbosityOf (common));
  bool whole = true;
  withFailureJson (common.json, [&] { whole = evaluate (settings, terminal); });
  if (!whole)
    throw IoError ("a file could not be read, see the warnings; the rest was evaluated");
}
