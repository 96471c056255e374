// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_command.h"

#include "evaluation_output.h"
#include "mesh_surroundings.h"
#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/evaluation/point_set.h"
#include "pcl_cosection/evaluation/rigid_alignment.h"
#include "pcl_cosection/io/cloud/surface_file.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/common/time.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

constexpr std::size_t all_vertices = std::numeric_limits<std::size_t>::max ();

const ProgramText&
meshText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate mesh",
      "accuracy, completeness, F-score and topology of a mesh",
      "pcl_cosection_evaluate mesh [OPTIONS] TRUTH RECONSTRUCTION",
      "Compares a reconstructed mesh with the true one.",
      {"Accuracy is the mean distance of points of the reconstruction to the truth, completeness that of points of the "
       "truth to the reconstruction: points are uniform by area, distances exact. Both meshes are in one frame and in "
       "metres: .ply, .stl, .obj, .off, .vtk or .vtp. They may be open; the volume is that of closed meshes.",
       "Either may be a scan, points without faces in a .ply or .pcd file: then its points are compared as they are, "
       "and "
       "distances to it are those to its nearest point, no smaller than about half of their spacing, which is "
       "printed."},
      {
          {"pcl_cosection_evaluate mesh truth.ply cup.ply", "the table on the terminal"},
          {"pcl_cosection_evaluate mesh --error-picture cup.png truth.ply cup.ply",
           "also a picture of where the errors are"},
          {"pcl_cosection_evaluate mesh --obstacle table.ply truth.ply cup.ply",
           "also how deep the cup is in the table"},
          {"pcl_cosection_evaluate mesh --pose 1,0,0,0,0,0,1 --align icp truth.ply cup.ply",
           "a mesh in another frame, whose pose is known roughly"},
      },
      {"samples = 100000", "obstacle = table.ply"},
  };
  return (text);
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
  constexpr double search_share = 0.1; // of the truth's diagonal
  RefinementOptions options;
  options.max_distance_m = search_share * summarizeMesh (truth).box.diagonal ().norm ();
  options.max_translation_m = options.max_distance_m;
  options.max_rotation_rad = 0.5;
  options.threads = threads;
  Refinement result;
  if (!isPointSet (truth))
    result = refineAlignment (isPointSet (reconstruction) ? somePoints (reconstruction, points)
                                                          : sampleSurface (reconstruction, points),
                              SurfaceDistance (truth), options);
  else // a plane at the nearest place is that of a triangle
  {
    result = refineAlignment (somePoints (truth, points), SurfaceDistance (reconstruction), options);
    result.correction = result.correction.inverse ();
  }
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
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< of the coordinates of both
  std::vector<std::string> warnings, notes;
  double read_s = 0.0, compare_s = 0.0, total_s = 0.0;
};

void
noteVolumes (MeshReport& report)
{
  for (const auto& [name, summary] :
       {std::pair{"truth", &report.truth}, std::pair{"reconstruction", &report.reconstruction}})
    if (summary->point_spacing_m)
      report.notes.push_back (
          std::string ("the ") + name + " is a set of points, " + inMillimetres (*summary->point_spacing_m) +
          " mm apart (median): distances to it are those to its nearest point, and it has no volume");
    else if (!summary->volume_m3)
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
    if (summary.point_spacing_m)
      return terminal.result (name + std::to_string (summary.vertices) + " points, " +
                              inMillimetres (*summary.point_spacing_m) + " mm apart");
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
  table.print (terminal);
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
  json["volume_error"] = orNull (report.volume_error);
  addSurroundings (report.surroundings, json);
  json["truth"] = toJson (report.truth);
  json["truth"]["file"] = settings.paths[0];
  json["reconstruction"] = toJson (report.reconstruction);
  json["reconstruction"]["file"] = settings.paths[1];
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
          csvRow ({settings.paths[0], settings.paths[1], toField (c.accuracy.mean), toField (c.completeness.mean),
                   toField (c.f_score), toField (c.precision), toField (c.recall),
                   report.reconstruction.topology.closed_manifold ? "1" : "0", toField (report.volume_error),
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
    options.threads = settings.threads;
    writePng (drawErrorPicture (truth, reconstruction, options), settings.error_picture);
    terminal.result ("wrote " + settings.error_picture);
  }
  if (!settings.error_mesh.empty ())
  {
    const std::vector<double> distances = isPointSet (truth)
                                              ? distancesToPoints (truth, somePoints (reconstruction, all_vertices), 1,
                                                                   settings.threads)
                                              : vertexDistances (reconstruction, SurfaceDistance (truth),
                                                                 settings.threads);
    reconstruction.colours = errorColours (distances, error_max_m);
    saveMesh (reconstruction, settings.error_mesh, report.origin);
    terminal.result ("wrote " + settings.error_mesh + ", red at " + inMillimetres (error_max_m) + " mm");
  }
}

/** \brief Refuse what only meshes can show. */
void
requireMeshes (const MeshSettings& settings, const TriangleMesh& truth, const TriangleMesh& reconstruction)
{
  const bool any = isPointSet (truth) || isPointSet (reconstruction),
             all = isPointSet (truth) && isPointSet (reconstruction);
  const std::string reason = " needs meshes, and " + settings.paths[isPointSet (truth) ? 0 : 1] + " holds points alone";
  if (any && !settings.error_picture.empty ())
    throw UsageError ("--error-picture" + reason);
  if (all && settings.align == "icp")
    throw UsageError ("--align icp" + reason + ", as the other file does");
  if (isPointSet (reconstruction) && (!settings.obstacles.empty () || !settings.error_mesh.empty ()))
    throw UsageError (std::string (settings.error_mesh.empty () ? "--obstacle" : "--error-mesh") + reason);
}

bool
compare (const MeshSettings& settings, Terminal& terminal)
{
  const pcl::StopWatch total;
  MeshReport report;
  const SurfaceFile truth_file = loadSurface (settings.paths[0]);
  const TriangleMesh& truth = truth_file.mesh;
  report.origin = truth_file.origin;
  SurfaceFile reconstruction_file = loadSurface (settings.paths[1]);
  TriangleMesh& reconstruction = reconstruction_file.mesh;
  requireMeshes (settings, truth, reconstruction);
  report.read_s = total.getTimeSeconds ();

  const Eigen::Translation3d truth_origin (report.origin), reconstruction_origin (reconstruction_file.origin);
  report.T_truth_reconstruction = truth_origin.inverse () * poseOf (settings.pose) * reconstruction_origin;
  reconstruction = transformMesh (std::move (reconstruction), report.T_truth_reconstruction);
  report.warnings = frameWarnings (summarizeMesh (truth), summarizeMesh (reconstruction));
  if (settings.align == "icp")
  {
    report.refinement = alignByIcp (truth, settings.threads, reconstruction);
    report.T_truth_reconstruction = report.refinement->correction * report.T_truth_reconstruction;
    if (report.refinement->limited)
      report.warnings.emplace_back (
          "icp wants to move the reconstruction farther than is allowed: give a better --pose");
  }
  report.T_truth_reconstruction = truth_origin * report.T_truth_reconstruction * reconstruction_origin.inverse ();
  report.truth = summarizeMesh (truth);
  report.reconstruction = summarizeMesh (reconstruction);
  noteVolumes (report);

  const pcl::StopWatch comparing;
  report.comparison = compareMeshes (truth, reconstruction, settings.comparison (settings.threads));
  report.compare_s = comparing.getTimeSeconds ();
  report.surroundings = measureSurroundings (settings, report.origin, reconstruction, report.warnings);

  for (const std::string& warning : report.warnings)
    terminal.warning (warning);
  print (settings, report, terminal);
  writeErrors (settings, report, truth, reconstruction, terminal);
  report.total_s = total.getTimeSeconds ();
  terminal.detail ("read " + toText (report.read_s) + " s, compared " + toText (report.compare_s) + " s, all " +
                   toText (report.total_s) + " s");
  if (!settings.json.empty ())
    saveJson (reportJson (settings, report), settings.json);
  if (!settings.csv.empty ())
    saveText (toCsv (settings, report), settings.csv);
  return (true);
}

void
check (const MeshSettings& settings)
{
  std::vector<std::string> inputs = settings.paths;
  inputs.insert (inputs.end (), settings.obstacles.begin (), settings.obstacles.end ());
  inputs.insert (inputs.end (), settings.views.begin (), settings.views.end ());
  inputs.push_back (configurationFile (settings.arguments));
  refuseToOverwrite (inputs, {settings.json, settings.csv, settings.error_mesh, settings.error_picture});
  if (!settings.error_mesh.empty () && !endsWith (settings.error_mesh, ".ply"))
    throw UsageError ("--error-mesh must end in .ply, for colours; it is " + settings.error_mesh);
  if (!settings.error_picture.empty () && !endsWith (settings.error_picture, ".png"))
    throw UsageError ("--error-picture must end in .png; it is " + settings.error_picture);
  poseOf (settings.pose);
  upOf (settings.up);
}

void
declareMeshOptions (CLI::App& app, MeshSettings& settings)
{
  OptionGroup comparison (app, "Comparison"), surroundings (app, "Surroundings"), output (app, "Output");
  declareSurfaceOptions (comparison, settings);
  comparison.add ("--pose TX,TY,TZ,QX,QY,QZ,QW", settings.pose,
                  "Pose of the reconstruction in the frame of the truth (default: the same frame)");
  comparison.add ("--align none|icp", settings.align,
                  "Refine the pose, by point-to-plane ICP, before comparing (default: none)");
  surroundings.add ("--obstacle MESH", settings.obstacles,
                    "Mesh (frame of the truth) that the reconstruction should not enter; repeatable");
  surroundings.add ("--penetration-voxel METRES", settings.penetration_voxel_m, positiveNumber (),
                    "Voxels of the volume inside obstacles (default: 1/128 of the smaller box)");
  surroundings.add ("--free-space VIEW.pcd", settings.views,
                    "Organised PCD view whose VIEWPOINT is the sensor in the frame of the truth: no surface should be "
                    "in front of what it measured; repeatable");
  surroundings.add ("--free-space-tolerance METRES", settings.free_space_tolerance_m, numberRange (0, unlimited),
                    "How far in front is no violation" + byDefault (settings.free_space_tolerance_m));
  output.add ("--error-picture FILE.png", settings.error_picture,
              "Draw both meshes, coloured by their distance to each other");
  output.add ("--error-mesh FILE.ply", settings.error_mesh,
              "Write the reconstruction, its vertices coloured by their distance to the truth");
  output.add ("--error-max METRES", settings.error_max_m, positiveNumber (),
              "Error at the red end of the colours (default: where 95 % of both meshes are below, rounded up)");
  output.add ("--up X,Y,Z", settings.up, "What points up in the picture (default: 0,0,1)");
  declareCommonOptions (app, settings);
}

} // namespace

EvaluationCommand
meshCommand ()
{
  return (
      makeCommand<MeshSettings> ("mesh", meshText (), "TRUTH", "RECONSTRUCTION", declareMeshOptions, compare, check));
}
