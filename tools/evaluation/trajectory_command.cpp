// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_command.h"

#include "common_options.h"
#include "evaluation_output.h"
#include "option_values.h"
#include "output_files.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

using namespace pcl::cosection;

namespace {

struct TrajectoryCommandSettings : CommonOptions, TrajectorySettings
{};

const ProgramText&
trajectoryText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate trajectory",
      "absolute and relative errors of a trajectory (ATE, RPE)",
      "pcl_cosection_evaluate trajectory [OPTIONS] TRUTH ESTIMATE",
      "Compares an estimated trajectory with the true one.",
      {"Both files have a line \"stamp tx ty tz qx qy qz qw\" for each pose, as in the TUM RGB-D benchmark. The "
       "absolute trajectory error (ATE) is the distance of aligned positions, the relative pose error (RPE) that of "
       "motions between poses."},
      {
          {"pcl_cosection_evaluate trajectory groundtruth.txt camera.txt", "the table on the terminal"},
          {"pcl_cosection_evaluate trajectory --delta 30 groundtruth.txt camera.txt", "with the drift over 30 poses"},
      },
      {"max-difference = 0.02", "delta = 30"},
  };
  return (text);
}

std::string
spanText (std::size_t poses, double begin, double end)
{
  return (counted (poses, "pose") + ", " + (poses == 1 ? "stamp " : "stamps ") + toShortText (begin) +
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
  table.print (terminal);
  if (error.rpe_pairs > 0)
    terminal.result (
        "RPE of " + std::to_string (error.rpe_pairs) + " motions over " + counted (delta, "pose") +
        (error.rpe_left_out > 0 ? "; " + std::to_string (error.rpe_left_out) + " left out, with gaps" : ""));
}

bool
compare (const TrajectoryCommandSettings& settings, Terminal& terminal)
{
  const auto truth = loadTrajectory (settings.paths[0]);
  const auto estimate = loadTrajectory (settings.paths[1]);
  TrajectoryError error;
  try
  {
    error = compareTrajectories (truth, estimate, settings.options ());
  }
  catch (const DegenerateInput& reason)
  {
    throw DegenerateInput (settings.paths[1] + ": " + reason.what ());
  }
  for (const std::string& note : error.notes)
    terminal.warning (note);
  print (error, settings.delta, terminal);
  if (!settings.json.empty ())
  {
    Json json;
    addTrajectoryError (error, json);
    json["parameters"] = {{"align", settings.align}, {"delta", settings.delta}};
    json["truth"] = settings.paths[0];
    json["estimate"] = settings.paths[1];
    saveJson (json, settings.json);
  }
  if (!settings.csv.empty ())
    saveText (
        csvRow ({"truth", "estimate", "matched", "ate_rmse_m", "ate_max_m", "rpe_trans_rmse_m", "rpe_rot_rmse_deg"}) +
            csvRow ({settings.paths[0], settings.paths[1], std::to_string (error.matched), toField (error.ate_m.rmse),
                     toField (error.ate_m.max), error.rpe_pairs > 0 ? toField (error.rpe_trans_m.rmse) : "",
                     error.rpe_pairs > 0 ? toField (degrees_per_rad * error.rpe_rot_rad.rmse) : ""}),
        settings.csv);
  return (true);
}

} // namespace

void
declareTrajectoryOptions (CLI::App& app, TrajectorySettings& settings)
{
  OptionGroup trajectories (app, "Trajectories");
  trajectories.add ("--max-difference SECONDS", settings.max_difference_s, numberRange (0, unlimited),
                    "Stamps that differ by more do not match (default: half the truth's median period)");
  trajectories.add ("--align se3|first|none", settings.align,
                    "How the estimate is brought into the frame of the truth: rotation and translation of least "
                    "squares (se3), by the first match (first), or not at all (default: se3)");
  trajectories.add ("--delta N", settings.delta, wholeRange (1, 1000000),
                    "Matched poses between the two ends of a motion of the RPE" + byDefault (1));
}

TrajectoryOptions
TrajectorySettings::options () const
{
  TrajectoryOptions options;
  options.max_difference_s = max_difference_s;
  options.alignment = align == "none"    ? TrajectoryAlignment::None
                      : align == "first" ? TrajectoryAlignment::First
                                         : TrajectoryAlignment::Se3;
  options.delta = delta;
  return (options);
}

EvaluationCommand
trajectoryCommand ()
{
  return (makeCommand<TrajectoryCommandSettings> (
      "trajectory", trajectoryText (), "TRUTH", "ESTIMATE",
      [] (CLI::App& app, TrajectoryCommandSettings& settings) {
        declareTrajectoryOptions (app, settings);
        declareCommonOptions (app, settings);
      },
      compare));
}
