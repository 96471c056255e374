// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_command.h"

#include "arguments.h"
#include "evaluation_json.h"
#include "evaluation_text.h"
#include "failure_json.h"
#include "mesh_surroundings.h"
#include "option_values.h"
#include "output_files.h"
#include "text_table.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/evaluation/rigid_alignment.h"
#include "pcl_cosection/evaluation/surface_distance.h"
#include "pcl_cosection/evaluation/surface_samples.h"
#include "pcl_cosection/rendering/picture.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <chrono>
#include <cmath>

using namespace pcl::cosection;

namespace {

double
now ()
{
  return (std::chrono::duration<double> (std::chrono::steady_clock::now ().time_since_epoch ()).count ());
}

Eigen::Isometry3d
poseOf (const std::vector<std::string>& values)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  if (values.empty ())
    return (pose);
  const auto n = parseNumbers (values);
  if (!n || n->size () != 7)
    throw UsageError ("--pose must be seven numbers tx,ty,tz,qx,qy,qz,qw");
  const Eigen::Quaterniond rotation ((*n)[6], (*n)[3], (*n)[4], (*n)[5]);
  if (!(rotation.norm () > 1e-3))
    throw UsageError ("--pose has a quaternion qx,qy,qz,qw of length zero");
  pose.linear () = rotation.normalized ().toRotationMatrix ();
  pose.translation () << (*n)[0], (*n)[1], (*n)[2];
  return (pose);
}

Eigen::Vector3d
upOf (const std::vector<std::string>& values)
{
  if (values.empty ())
    return (Eigen::Vector3d::UnitZ ());
  const auto n = parseNumbers (values);
  if (!n || n->size () != 3 || !(Eigen::Vector3d (n->data ()).norm () > 0.0))
    throw UsageError ("--up must be a direction x,y,z");
  return (Eigen::Vector3d (n->data ()));
}

/** \brief Move the reconstruction onto the truth. */
Refinement
alignByIcp (const TriangleMesh& truth, int threads, TriangleMesh& reconstruction)
{
  constexpr std::size_t points = 5000;
  constexpr double search_share = 0.1; // of the true mesh's diagonal
  RefinementOptions options;
  options.max_distance_m = search_share * summarizeMesh (truth).box.diagonal ().norm ();
  options.max_translation_m = options.max_distance_m;
  options.max_rotation_rad = 0.5;
  options.threads = threads;
  const Refinement result = refineAlignment (sampleSurface (reconstruction, points), SurfaceDistance (truth), options);
  reconstruction = transformMesh (std::move (reconstruction), result.correction);
  return (result);
}

/** \brief A direction that is not along \a up, for the first camera. */
Eigen::Vector3d
frontFor (const Eigen::Vector3d& up)
{
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors (Eigen::Vector3d::UnitZ (), up.normalized ());
  return (turn * ErrorPictureOptions ().front);
}

/** \brief All that is known of two meshes. */
struct MeshReport
{
  MeshSummary truth, reconstruction;
  MeshComparison comparison;
  std::optional<double> volume_error;
  std::optional<Refinement> refinement;
  Eigen::Isometry3d T_truth_reconstruction = Eigen::Isometry3d::Identity ();
  Surroundings surroundings;
  std::vector<std::string> warnings, notes;
  double read_s = 0.0, compare_s = 0.0, total_s = 0.0;
};

void
noteVolumes (MeshReport& report)
{
  for (const auto& [name, summary] :
       {std::pair{"truth", &report.truth}, std::pair{"reconstruction", &report.reconstruction}})
    if (!summary->volume_m3)
      report.notes.push_back (std::string ("the ") + name + " is " +
                              (summary->topology.boundary_edges > 0 ? "open" : "not a manifold") +
                              " and has no volume");
  if (report.truth.volume_m3 && report.reconstruction.volume_m3 && *report.truth.volume_m3 != 0.0)
    report.volume_error = *report.reconstruction.volume_m3 / *report.truth.volume_m3 - 1.0;
}

void
print (const MeshSettings& settings, const MeshReport& report, Terminal& terminal)
{
  const auto line = [&] (const std::string& name, const MeshSummary& summary) {
    terminal.result (name + std::to_string (summary.triangles) + " triangles, " + describeTopology (summary.topology) +
                     (summary.volume_m3 ? ", " + inMillilitres (*summary.volume_m3) + " ml" : ""));
  };
  line ("truth:          ", report.truth);
  line ("reconstruction: ", report.reconstruction);
  if (report.refinement)
    terminal.result ("moved by icp:   " + inMillimetres (report.refinement->translation_m) + " mm, " +
                     toText (report.refinement->rotation_rad * 180.0 / M_PI) + " degrees");
  terminal.result ("");
  TextTable table ({"", "mean", "median", "95 %", "max", "(mm)"});
  const auto row = [&] (const std::string& name, const ErrorStatistics& s) {
    table.add ({name, inMillimetres (s.mean), inMillimetres (s.median), inMillimetres (s.p95), inMillimetres (s.max)});
  };
  row ("accuracy", report.comparison.accuracy);
  row ("completeness", report.comparison.completeness);
  for (const std::string& text : table.lines ())
    terminal.result (text);
  terminal.result ("F-score at " + toShortText (1000.0 * settings.f_threshold_m) +
                   " mm: " + toText (report.comparison.f_score) + " (precision " +
                   toText (report.comparison.precision) + ", recall " + toText (report.comparison.recall) + ")");
  if (report.volume_error)
    terminal.result ("volume: " + std::string (*report.volume_error >= 0.0 ? "+" : "") +
                     inPercent (*report.volume_error));
  for (const std::string& note : report.notes)
    terminal.result ("note: " + note);
  print (report.surroundings, terminal);
}

Json
reportJson (const MeshSettings& settings, const MeshReport& report)
{
  Json json;
  addComparison (report.comparison, settings.f_threshold_m, json);
  json["closed"] = report.reconstruction.topology.closed_manifold;
  json["volume_error"] = report.volume_error ? Json (*report.volume_error) : Json ();
  addSurroundings (report.surroundings, json);
  json["truth"] = toJson (report.truth);
  json["truth"]["file"] = settings.common.paths[0];
  json["reconstruction"] = toJson (report.reconstruction);
  json["reconstruction"]["file"] = settings.common.paths[1];
  json["T_truth_reconstruction"] = toJson (report.T_truth_reconstruction);
  json["parameters"] = {{"samples", settings.samples},
                        {"seed", settings.seed},
                        {"align", settings.align},
                        {"free_space_tolerance_m", settings.free_space_tolerance_m}};
  json["timings_s"] = {{"read", report.read_s}, {"compare", report.compare_s}, {"total", report.total_s}};
  json["notes"] = report.notes;
  json["warnings"] = report.warnings;
  return (json);
}

std::string
toCsv (const MeshSettings& settings, const MeshReport& report)
{
  const MeshComparison& c = report.comparison;
  return (csvRow ({"truth", "reconstruction", "accuracy_m", "completeness_m", "f_score", "precision", "recall",
                   "closed", "volume_error", "penetration_m", "free_space_violation"}) +
          csvRow ({settings.common.paths[0], settings.common.paths[1], toField (c.accuracy.mean),
                   toField (c.completeness.mean), toField (c.f_score), toField (c.precision), toField (c.recall),
                   report.reconstruction.topology.closed_manifold ? "1" : "0",
                   report.volume_error ? toField (*report.volume_error) : "",
                   report.surroundings.obstacles.empty () ? "" : toField (report.surroundings.penetration_m ()),
                   report.surroundings.free_space ? toField (report.surroundings.free_space->share) : ""}));
}

/** \brief The mesh and the picture that show where the errors are. */
void
writeErrors (const MeshSettings& settings, const MeshReport& report, const TriangleMesh& truth,
             TriangleMesh reconstruction, Terminal& terminal)
{
  const double error_max_m = settings.error_max_m > 0.0 ? settings.error_max_m
                                                        : roundErrorUp (std::max (report.comparison.accuracy.p95,
                                                                                  report.comparison.completeness.p95));
  if (!settings.error_picture.empty ())
  {
    ErrorPictureOptions options;
    options.error_max_m = error_max_m;
    options.up = upOf (settings.up);
    options.front = frontFor (options.up);
    options.reconstruction_caption += ", " + inMillimetres (report.comparison.accuracy.mean) + " mm on average";
    options.truth_caption += ", " + inMillimetres (report.comparison.completeness.mean) + " mm on average";
    options.threads = settings.common.threads.value_or (0);
    writePng (drawErrorPicture (truth, reconstruction, options), settings.error_picture);
    terminal.result ("wrote " + settings.error_picture);
  }
  if (!settings.error_mesh.empty ())
  {
    reconstruction.colours = errorColours (
        vertexDistances (reconstruction, SurfaceDistance (truth), settings.common.threads.value_or (0)), error_max_m);
    saveMesh (reconstruction, settings.error_mesh);
    terminal.result ("wrote " + settings.error_mesh + ", red at " + inMillimetres (error_max_m) + " mm");
  }
}

void
compare (const MeshSettings& settings, Terminal& terminal)
{
  const double begin = now ();
  MeshReport report;
  const TriangleMesh truth = loadMesh (settings.common.paths[0]);
  TriangleMesh reconstruction = loadMesh (settings.common.paths[1]);
  report.read_s = now () - begin;

  report.T_truth_reconstruction = poseOf (settings.pose);
  reconstruction = transformMesh (std::move (reconstruction), report.T_truth_reconstruction);
  report.warnings = frameWarnings (summarizeMesh (truth), summarizeMesh (reconstruction));
  if (settings.align == "icp")
  {
    report.refinement = alignByIcp (truth, settings.common.threads.value_or (0), reconstruction);
    report.T_truth_reconstruction = report.refinement->correction * report.T_truth_reconstruction;
    if (report.refinement->limited)
      report.warnings.emplace_back (
          "icp wants to move the reconstruction farther than is allowed: give a better --pose");
  }
  report.truth = summarizeMesh (truth);
  report.reconstruction = summarizeMesh (reconstruction);
  noteVolumes (report);

  const double compare_begin = now ();
  MeshComparisonOptions options;
  options.samples = static_cast<std::size_t> (settings.samples);
  options.seed = settings.seed;
  options.f_threshold_m = settings.f_threshold_m;
  options.threads = settings.common.threads.value_or (0);
  report.comparison = compareMeshes (truth, reconstruction, options);
  report.compare_s = now () - compare_begin;
  report.surroundings = measureSurroundings (settings, reconstruction, report.warnings);

  for (const std::string& warning : report.warnings)
    terminal.warning (warning);
  print (settings, report, terminal);
  writeErrors (settings, report, truth, reconstruction, terminal);
  report.total_s = now () - begin;
  terminal.detail ("read " + toText (report.read_s) + " s, compared " + toText (report.compare_s) + " s, all " +
                   toText (report.total_s) + " s");
  if (!settings.common.json.empty ())
    saveJson (reportJson (settings, report), settings.common.json);
  if (!settings.common.csv.empty ())
    saveText (toCsv (settings, report), settings.common.csv);
}

void
check (const MeshSettings& settings)
{
  checkCommonOptions (settings.common, "TRUTH", "RECONSTRUCTION");
  std::vector<std::string> inputs = settings.common.paths;
  inputs.insert (inputs.end (), settings.obstacles.begin (), settings.obstacles.end ());
  inputs.insert (inputs.end (), settings.views.begin (), settings.views.end ());
  refuseToOverwrite (inputs, {settings.common.json, settings.common.csv, settings.error_mesh, settings.error_picture});
  const auto endsWith = [] (const std::string& name, const std::string& end) {
    return (name.size () > end.size () && name.compare (name.size () - end.size (), end.size (), end) == 0);
  };
  if (!settings.error_mesh.empty () && !endsWith (settings.error_mesh, ".ply"))
    throw UsageError ("--error-mesh must end in .ply, for colours; it is " + settings.error_mesh);
  if (!settings.error_picture.empty () && !endsWith (settings.error_picture, ".png"))
    throw UsageError ("--error-picture must end in .png; it is " + settings.error_picture);
  poseOf (settings.pose);
  upOf (settings.up);
}

} // namespace

void
runMeshCommand (int argc, const char* const* argv, Terminal& terminal)
{
  CLI::App app;
  MeshSettings settings;
  declareMeshOptions (app, settings);
  if (!parseArguments (app, meshText (), argc, argv))
    return;
  check (settings);
  terminal.setVerbosity (verbosityOf (settings.common));
  withFailureJson (settings.common.json, [&] { compare (settings, terminal); });
}
