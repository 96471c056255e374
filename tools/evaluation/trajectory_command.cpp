// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_command.h"

#include "arguments.h"
#include "evaluation_json.h"
#include "evaluation_text.h"
#include "failure_json.h"
#include "option_values.h"
#include "output_files.h"
#include "text_table.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

std::string
spanText (std::size_t poses, double begin, double end)
{
  return (std::to_string (poses) + (poses == 1 ? " pose, stamp " : " poses, stamps ") + toShortText (begin) +
          (poses == 1 ? "" : " to " + toShortText (end)));
}

void
print (const TrajectoryError& error, int delta, Terminal& terminal)
{
  terminal.result ("truth:    " + spanText (error.truth_poses, error.truth_begin_s, error.truth_end_s));
  terminal.result ("estimate: " + spanText (error.estimate_poses, error.estimate_begin_s, error.estimate_end_s));
  const auto share = [&] (std::size_t poses) {
    return (inPercent (static_cast<double> (error.matched) / static_cast<double> (poses)));
  };
  terminal.result ("matched:  " + std::to_string (error.matched) + ", " + share (error.truth_poses) +
                   " of the truth and " + share (error.estimate_poses) + " of the estimate; largest gap " +
                   toShortText (error.largest_gap_s) + ", path " + toText (error.path_m) + " m");
  terminal.result ("");
  TextTable table ({"", "rmse", "mean", "median", "max"});
  const auto row = [&] (const std::string& name, const ErrorStatistics& s, double factor) {
    table.add ({name, toText (factor * s.rmse), toText (factor * s.mean), toText (factor * s.median),
                toText (factor * s.max)});
  };
  row ("ATE (mm)", error.ate_m, 1000.0);
  if (error.rpe_pairs > 0)
  {
    row ("RPE (mm)", error.rpe_trans_m, 1000.0);
    row ("RPE (degrees)", error.rpe_rot_rad, degrees_per_rad);
  }
  for (const std::string& line : table.lines ())
    terminal.result (line);
  if (error.rpe_pairs > 0)
    terminal.result (
        "RPE of " + std::to_string (error.rpe_pairs) + " motions over " + std::to_string (delta) +
        (delta == 1 ? " pose" : " poses") +
        (error.rpe_left_out > 0 ? "; " + std::to_string (error.rpe_left_out) + " left out, with gaps" : ""));
}

void
compare (const TrajectorySettings& settings, Terminal& terminal)
{
  const auto truth = loadTrajectory (settings.common.paths[0]);
  const auto estimate = loadTrajectory (settings.common.paths[1]);
  TrajectoryError error;
  try
  {
    error = compareTrajectories (truth, estimate, trajectoryOptions (settings));
  }
  catch (const DegenerateInput& reason)
  {
    throw DegenerateInput (settings.common.paths[1] + ": " + reason.what ());
  }
  for (const std::string& note : error.notes)
    terminal.warning (note);
  print (error, settings.delta, terminal);
  if (!settings.common.json.empty ())
  {
    Json json;
    addTrajectoryError (error, json);
    json["parameters"] = {{"align", settings.align}, {"delta", settings.delta}};
    json["truth"] = settings.common.paths[0];
    json["estimate"] = settings.common.paths[1];
    saveJson (json, settings.common.json);
  }
  if (!settings.common.csv.empty ())
    saveText (
        csvRow ({"truth", "estimate", "matched", "ate_rmse_m", "ate_max_m", "rpe_trans_rmse_m", "rpe_rot_rmse_deg"}) +
            csvRow ({settings.common.paths[0], settings.common.paths[1], std::to_string (error.matched),
                     toField (error.ate_m.rmse), toField (error.ate_m.max),
                     error.rpe_pairs > 0 ? toField (error.rpe_trans_m.rmse) : "",
                     error.rpe_pairs > 0 ? toField (degrees_per_rad * error.rpe_rot_rad.rmse) : ""}),
        settings.common.csv);
}

} // namespace

void
declareComparisonOptions (CLI::App& app, TrajectorySettings& settings)
{
  const std::string group = "Trajectories";
  app.add_option ("--max-difference", settings.max_difference_s,
                  "Stamps that differ by more do not match (default: half the truth's median period)")
      ->option_text ("SECONDS")
      ->check (numberRange (0, std::numeric_limits<double>::max ()))
      ->group (group);
  app.add_option ("--align", settings.align,
                  "How the estimate is brought into the frame of the truth: rotation and translation of least squares "
                  "(se3), by the first match (first), or not at all (default: se3)")
      ->option_text ("se3|first|none")
      ->check (CLI::IsMember (std::vector<std::string>{"se3", "first", "none"}))
      ->group (group);
  app.add_option ("--delta", settings.delta,
                  "Matched poses between the two ends of a motion of the RPE" + byDefault (1))
      ->option_text ("N")
      ->check (wholeRange (1, 1000000))
      ->group (group);
}

void
declareTrajectoryOptions (CLI::App& app, TrajectorySettings& settings)
{
  declareComparisonOptions (app, settings);
  declareCommonOptions (app, settings.common);
}

TrajectoryOptions
trajectoryOptions (const TrajectorySettings& settings)
{
  TrajectoryOptions options;
  options.max_difference_s = settings.max_difference_s;
  options.alignment = settings.align == "none"    ? TrajectoryAlignment::None
                      : settings.align == "first" ? TrajectoryAlignment::First
                                                  : TrajectoryAlignment::Se3;
  options.delta = settings.delta;
  return (options);
}

void
runTrajectoryCommand (int argc, const char* const* argv, Terminal& terminal)
{
  CLI::App app;
  TrajectorySettings settings;
  declareTrajectoryOptions (app, settings);
  if (!parseArguments (app, trajectoryText (), argc, argv))
    return;
  checkCommonOptions (settings.common, "TRUTH", "ESTIMATE");
  refuseToOverwrite (settings.common.paths, {settings.common.json, settings.common.csv});
  terminal.setVerbosity (verbosityOf (settings.common));
  withFailureJson (settings.common.json, [&] { compare (settings, terminal); });
}
