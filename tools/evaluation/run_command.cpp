// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_command.h"

#include "common_options.h"
#include "evaluation_output.h"
#include "option_values.h"
#include "output_files.h"
#include "trajectory_command.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

using namespace pcl::cosection;

namespace {

/** \brief What the user asked of the command run. */
struct RunSettings : CommonOptions, SurfaceOptions, TrajectorySettings
{
  std::string refine = "observed"; ///< or none
};

const ProgramText&
runText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate run",
      "meshes, trajectories and penetration of a whole run",
      "pcl_cosection_evaluate run [OPTIONS] OUTPUT DATASET",
      "Compares a run on a sequence, poses and meshes of moving objects, with the truth of its dataset.",
      {"OUTPUT has trajectory/camera.txt, trajectory/object_ID.txt, mesh/object_ID.ply and mesh/background.ply. "
       "DATASET has gt-cam-0.txt, gt-NAME-ID.txt, gt-mesh/NAME.ply, gt-mesh/room.ply (or background.ply) and "
       "calibration.txt.",
       "The world and the frames of objects may differ: objects are matched by their overlap in the camera's frame and "
       "aligned by the median of their poses, refined on the observed surface. What is missing is said, the rest is "
       "evaluated."},
      {
          {"pcl_cosection_evaluate run output dataset", "the table on the terminal"},
          {"pcl_cosection_evaluate run --json run.json output dataset", "all numbers for programs"},
      },
      {"refine = none", "json = run.json"},
  };
  return (text);
}

std::string
rpeText (const TrajectoryError& error, bool rotation)
{
  if (error.rpe_pairs == 0)
    return ("-");
  return (rotation ? toText (degrees_per_rad * error.rpe_rot_rad.rmse) : inMillimetres (error.rpe_trans_m.rmse));
}

std::string
bodyName (int id)
{
  return (id == PairPenetration::background ? std::string ("background") : "object " + std::to_string (id));
}

std::string
trueName (const SceneRecord& truth, int id)
{
  for (const SceneRecord::Object& object : truth.objects)
    if (object.id == id)
      return (object.name);
  return (std::to_string (id));
}

std::string
alignmentText (const FrameAlignment& alignment)
{
  return ("median of " + counted (alignment.frames, "pose") + ", refined by " +
          inMillimetres (alignment.refinement.translation_m) + " mm and " +
          toText (degrees_per_rad * alignment.refinement.rotation_rad) + " degrees");
}

Json
alignmentJson (const FrameAlignment& alignment)
{
  return (Json{{"T_truth_estimate", toJson (alignment.T_truth_estimate)},
               {"frames", alignment.frames},
               {"refinement_m", alignment.refinement.translation_m},
               {"refinement_deg", degrees_per_rad * alignment.refinement.rotation_rad},
               {"refinement_limited", alignment.refinement.limited}});
}

void
addMesh (const MeshEvaluation& mesh, double f_threshold_m, Json& json)
{
  addComparison (mesh.comparison, f_threshold_m, json);
  json["closed"] = mesh.estimate.topology.closed_manifold;
  json["volume_error"] = orNull (mesh.volume_error);
  json["alignment"] = alignmentJson (mesh.alignment);
  json["mesh"] = toJson (mesh.estimate);
  json["truth_mesh"] = toJson (mesh.truth);
}

void
printObjects (const RunEvaluation& run, const RunSettings& settings, Terminal& terminal)
{
  TextTable table ({"object", "accuracy", "complete", "F@" + toShortText (1000.0 * settings.f_threshold_m), "closed",
                    "volume", "inside others", "ATE", "RPE", "RPE deg", "tracked/visible"});
  for (const ObjectEvaluation& o : run.objects)
    table.add ({std::to_string (o.id) + " " + o.truth_name, inMillimetres (o.mesh.comparison.accuracy.mean),
                inMillimetres (o.mesh.comparison.completeness.mean), toText (o.mesh.comparison.f_score),
                o.mesh.estimate.topology.closed_manifold ? "yes" : "no",
                o.mesh.volume_error ? (*o.mesh.volume_error >= 0.0 ? "+" : "") + inPercent (*o.mesh.volume_error) : "-",
                inMillimetres (o.penetration_m), inMillimetres (o.trajectory.ate_m.rmse), rpeText (o.trajectory, false),
                rpeText (o.trajectory, true),
                std::to_string (o.frames_tracked_visible) + "/" + std::to_string (o.frames_visible)});
  if (run.background)
    table.add ({"background", inMillimetres (run.background->comparison.accuracy.mean),
                inMillimetres (run.background->comparison.completeness.mean),
                toText (run.background->comparison.f_score),
                run.background->estimate.topology.closed_manifold ? "yes" : "no", "-"});
  table.print (terminal);
}

void
print (const RunEvaluation& run, const SceneRecord& truth, const RunSettings& settings, Terminal& terminal)
{
  terminal.result ("camera: " + std::to_string (run.camera.matched) + " of " + std::to_string (run.camera.truth_poses) +
                   " poses, ATE " + inMillimetres (run.camera.ate_m.rmse) + " mm, RPE " + rpeText (run.camera, false) +
                   " mm and " + rpeText (run.camera, true) + " degrees");
  for (const std::string& note : run.camera.notes)
    terminal.warning ("camera: " + note);
  terminal.result ("");
  if (!run.objects.empty () || run.background)
  {
    printObjects (run, settings, terminal);
    terminal.result ("(mm unless said; root mean squares of ATE and RPE)");
  }
  for (const PairPenetration& pair : run.penetrations)
    if (pair.depth_m > 0.0)
      terminal.result (bodyName (pair.first) + " and " + bodyName (pair.second) + ": " + inMillimetres (pair.depth_m) +
                       " mm inside each other in the frame of stamp " + toShortText (pair.stamp) +
                       (pair.volume_m3 ? ", " + inMillilitres (*pair.volume_m3) + " ml" : ""));
  for (const int id : run.unmatched)
    terminal.result ("object " + std::to_string (id) + " matches no true object");
  for (const int id : run.missed)
    terminal.result ("true object " + trueName (truth, id) + " was not found");
  for (const ObjectEvaluation& o : run.objects)
    terminal.detail ("object " + std::to_string (o.id) + ": overlap " + toText (o.overlap) + ", " +
                     alignmentText (o.mesh.alignment));
  if (run.background)
    terminal.detail ("background: " + alignmentText (run.background->alignment));
}

Json
runJson (const RunEvaluation& run, const SceneRecord& truth, const RunSettings& settings)
{
  Json json;
  json["camera"] = Json::object ();
  addTrajectoryError (run.camera, json["camera"]);
  json["objects"] = Json::array ();
  for (const ObjectEvaluation& o : run.objects)
  {
    Json object;
    object["id"] = o.id;
    object["truth"] = o.truth_name;
    object["truth_id"] = o.truth_id;
    object["overlap"] = o.overlap;
    addMesh (o.mesh, settings.f_threshold_m, object);
    object["penetration_m"] = o.penetration_m;
    object["penetration_m3"] = orNull (o.penetration_m3);
    object["frames_tracked"] = o.frames_tracked;
    object["frames_visible"] = o.frames_visible;
    object["frames_tracked_visible"] = o.frames_tracked_visible;
    addTrajectoryError (o.trajectory, object);
    object.erase ("T_truth_estimate"); // the identity: the alignment is that of the mesh
    json["objects"].push_back (object);
  }
  if (run.background)
    addMesh (*run.background, settings.f_threshold_m, json["background"]);
  else
    json["background"] = nullptr;
  json["penetrations"] = Json::array ();
  for (const PairPenetration& pair : run.penetrations)
    json["penetrations"].push_back (
        {{"first", pair.first},
         {"second", pair.second == PairPenetration::background ? Json ("background") : Json (pair.second)},
         {"penetration_m", pair.depth_m},
         {"penetration_m3", orNull (pair.volume_m3)},
         {"stamp", pair.stamp},
         {"frames", pair.frames}});
  json["unmatched"] = run.unmatched;
  json["missed"] = Json::array ();
  for (const int id : run.missed)
    json["missed"].push_back ({{"truth_id", id}, {"truth", trueName (truth, id)}});
  json["parameters"] = {{"samples", settings.samples},
                        {"seed", settings.seed},
                        {"refine", settings.refine},
                        {"align", settings.align},
                        {"delta", settings.delta}};
  json["warnings"] = run.warnings;
  return (json);
}

/** \brief A row for each object. */
std::string
runCsv (const RunEvaluation& run)
{
  std::string text = csvRow ({"id", "truth", "accuracy_m", "completeness_m", "f_score", "closed", "volume_error",
                              "penetration_m", "ate_rmse_m", "rpe_trans_rmse_m", "rpe_rot_rmse_deg", "frames_tracked",
                              "frames_visible", "refinement_m", "refinement_deg"});
  for (const ObjectEvaluation& o : run.objects)
  {
    const bool has_rpe = o.trajectory.rpe_pairs > 0;
    text += csvRow (
        {std::to_string (o.id), o.truth_name, toField (o.mesh.comparison.accuracy.mean),
         toField (o.mesh.comparison.completeness.mean), toField (o.mesh.comparison.f_score),
         o.mesh.estimate.topology.closed_manifold ? "1" : "0", toField (o.mesh.volume_error), toField (o.penetration_m),
         toField (o.trajectory.ate_m.rmse), has_rpe ? toField (o.trajectory.rpe_trans_m.rmse) : "",
         has_rpe ? toField (degrees_per_rad * o.trajectory.rpe_rot_rad.rmse) : "", std::to_string (o.frames_tracked),
         std::to_string (o.frames_visible), toField (o.mesh.alignment.refinement.translation_m),
         toField (degrees_per_rad * o.mesh.alignment.refinement.rotation_rad)});
  }
  return (text);
}

/** \return whether every file that is there could be read */
bool
evaluate (const RunSettings& settings, Terminal& terminal)
{
  ReadingNotes notes;
  const SceneRecord estimate = readRun (settings.paths[0], notes);
  const SceneRecord truth = readTruth (settings.paths[1], notes);
  RunOptions options;
  options.comparison = settings.comparison (settings.threads);
  options.trajectory = settings.options ();
  options.penetration.voxel_size_m = settings.penetration_voxel_m;
  options.penetration.seed = settings.seed;
  options.refine = settings.refine != "none";
  options.threads = settings.threads;
  RunEvaluation result = evaluateRun (truth, estimate, options);
  result.warnings.insert (result.warnings.begin (), notes.warnings.begin (), notes.warnings.end ());
  for (const std::string& warning : result.warnings)
    terminal.warning (warning);
  print (result, truth, settings, terminal);
  if (!settings.json.empty ())
    saveJson (runJson (result, truth, settings), settings.json);
  if (!settings.csv.empty ())
    saveText (runCsv (result), settings.csv);
  return (notes.whole);
}

void
declareRunOptions (CLI::App& app, RunSettings& settings)
{
  OptionGroup meshes (app, "Meshes");
  declareSurfaceOptions (meshes, settings);
  meshes.add ("--refine observed|none", settings.refine,
              "Refine the alignment of each object on its observed surface, by at most 2 cm and 5.7 degrees (default: "
              "observed)");
  meshes.add ("--penetration-voxel METRES", settings.penetration_voxel_m, positiveNumber (),
              "Voxels of the volume of penetration (default: 1/64 of the smaller box)");
  declareTrajectoryOptions (app, settings);
  declareCommonOptions (app, settings);
}

} // namespace

EvaluationCommand
runCommand ()
{
  return (makeCommand<RunSettings> ("run", runText (), "OUTPUT", "DATASET", declareRunOptions, evaluate));
}
