// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "export_report.h"

#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/io/lower_case.h"
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <algorithm>
#include <array>

using namespace pcl::cosection;

namespace {

void
declareInput (CLI::App& app, Given& given)
{
  OptionGroup input (app, "Input");
  input.addFlag ("--world-points", given.reading.world_points, "Points are in the world frame already");
  input.add ("--viewpoint X,Y,Z", given.viewpoint_values,
             "Where the sensor stood, for points in the world frame whose header does not say it; once for all views, "
             "or once for each");
  input.add ("--intrinsics FX,FY,CX,CY", given.intrinsics,
             "Camera in pixels, for organised clouds that no pinhole fits");
  input.add ("--scale FACTOR", given.reading.scale, positiveNumber (),
             "Multiplies all coordinates: 0.001 for millimetres");
  input.add ("--axes optical|opengl", given.axes,
             "Axes of the sensor's frame: x right, y down, z forward, or x right, y up, z backward" +
                 byDefault ("optical"));
  input.add ("--object-trajectory ID=FILE", given.trajectory_values,
             "Poses of object ID in the world, for views in which it moved: lines \"view tx ty tz qx qy qz qw\", views "
             "from 0; repeatable");
  input.add ("--free-space VIEW.pcd", given.free_space,
             "View that shows which space is free and nothing else: its labels and points are not used; numbered after "
             "the INPUTs; repeatable");
}

void
declareLabels (CLI::App& app, Given& given)
{
  OptionGroup labels (app, "Labels");
  labels.add ("--label-field NAME", given.reading.label_field,
              "Field that says to which object a point belongs (default: label, else class or classification)");
  labels.addFlag ("--segment", given.segment,
                  "Find the objects first, in one INPUT without labels: what stands on its planes");
  labels.add ("--max-object-size METRES", given.max_object_size_m, positiveNumber (),
              "What is longer is furniture or room for --segment" +
                  byDefault (ObjectSegmentationOptions ().max_object_size_m));
  labels.add ("--save-labels FILE.pcd", given.save_labels, "Write INPUT with the labels that --segment found");
  labels.add ("--background LABEL", given.reading.background_labels, wholeRange (0, 4294967295),
              "Label of the background" + byDefault (0) + "; repeatable");
  labels.add ("--ignore LABEL", given.reading.ignored_labels, wholeRange (0, 4294967295),
              "Label of points that are left out, beside negative ones and 65535; repeatable");
}

void
declareSurroundings (CLI::App& app, Given& given)
{
  OptionGroup surroundings (app, "Surroundings");
  surroundings.add (
      "--plane A,B,C,D", given.plane_values,
      "Plane a x + b y + c z + d = 0 (world, metres) that no object crosses: a table, a wall; repeatable");
  surroundings.add ("--obstacle MESH", given.obstacles,
                    "Mesh (world, metres) that no object enters: .ply, .stl, .obj, .off, .vtk or .vtp; repeatable");
  surroundings.add ("--proposal ID=MESH", given.proposal_values,
                    "Mesh that may be the shape of object ID, of any size and pose; it is aligned, and expected where "
                    "nothing was measured if it explains the rest; repeatable");
  surroundings.addFlag ("--no-planes", given.no_planes,
                        "Do not look for support planes in the background, nor guess them");
}

void
declareOutput (CLI::App& app, Given& given)
{
  OptionGroup output (app, "Output");
  output.add ("--format ply|stl|obj", given.format, "Format of the meshes in a folder" + byDefault ("ply"));
  output.add ("--max-faces N", given.max_faces, wholeRange (4, 2147483647),
              "Simplify each mesh to at most so many triangles, still closed");
  output.addFlag ("--save-hull", given.save_hull,
                  "Write each object's hull: all that may be it, as no view saw it free (_hull)");
  output.addFlag (
      "--save-bounds", given.save_bounds,
      "Write bounds for collision checks: matter surely there (_inner), and the hull with the mesh, two sigma larger "
      "(_outer)");
  output.addFlag ("--save-sdf", given.save_sdf, "Write each object's signed distance beside its mesh (.vti)");
  output.add ("--json FILE", given.json, "Write a summary for programs");
  declareExport (output, given.exports);
}

void
setPaths (Settings& settings)
{
  requirePaths (settings.paths, "INPUT", "OUTPUT", true);
  settings.inputs.assign (settings.paths.begin (), settings.paths.end () - 1);
  settings.output = settings.paths.back ();
  const std::string possible = "; it must be a folder, or a file ending in .ply, .stl or .obj";
  if (settings.output.empty ())
    throw UsageError ("OUTPUT is empty" + possible);
  const std::string extension = lowerCaseExtension (settings.output);
  if (extension == ".pcd")
    throw UsageError ("OUTPUT is " + settings.output + ", a point cloud" + possible);
  constexpr std::array<const char*, 10> unwritten{".off",  ".vtk", ".vtp", ".dae", ".glb",
                                                  ".gltf", ".fbx", ".3ds", ".3mf", ".wrl"};
  if (std::find (unwritten.begin (), unwritten.end (), extension) != unwritten.end ())
    throw UsageError ("OUTPUT is " + settings.output + ", a format that is not written" + possible);
  const std::string mesh = meshExtension (settings.output);
  if (!mesh.empty () && !settings.format.empty () && settings.format != mesh)
    throw UsageError ("--format " + settings.format + " contradicts OUTPUT " + settings.output);
  if (!mesh.empty () && !settings.exports.empty ())
    throw UsageError ("--export needs a folder as OUTPUT, not " + settings.output);
  if (!mesh.empty () || settings.format.empty ())
    settings.format = mesh.empty () ? "ply" : mesh;
}

void
setPlanes (Settings& settings)
{
  if (settings.plane_values.empty ())
    return;
  const auto planes = parseTuples<4> (settings.plane_values);
  if (!planes)
    throw UsageError ("--plane must be four numbers a,b,c,d");
  for (const auto& p : *planes)
  {
    settings.planes.emplace_back (p[0], p[1], p[2], p[3]);
    if (!(settings.planes.back ().head<3> ().norm () > 0.0))
      throw UsageError ("--plane has the normal 0,0,0; its first three numbers must not all be zero");
  }
}

void
setViewpoints (Settings& settings)
{
  if (settings.viewpoint_values.empty ())
    return;
  const auto viewpoints = parseTuples<3> (settings.viewpoint_values);
  if (!viewpoints)
    throw UsageError ("--viewpoint must be three numbers x,y,z");
  const std::size_t views = settings.inputs.size () + settings.free_space.size ();
  settings.viewpoints = *viewpoints;
  if (settings.viewpoints.size () == 1)
    settings.viewpoints.assign (views, settings.viewpoints[0]);
  if (settings.viewpoints.size () != views)
    throw UsageError ("--viewpoint is given " + std::to_string (settings.viewpoints.size ()) + " times for " +
                      std::to_string (views) + " views; give one for all, or one for each");
}

void
interpret (Settings& settings)
{
  setPaths (settings);
  settings.object_trajectories = parseObjectFiles ("--object-trajectory", settings.trajectory_values);
  for (const std::string& value : settings.proposal_values)
    settings.proposals.push_back (parseObjectFile ("--proposal", value));
  settings.method = methodOptions (settings);
  if (!settings.model.empty () && !settings.method.activePriors ().learned)
    throw UsageError ("--model has no effect: --priors or --preset turn the learned prior off");
  if (!settings.proposals.empty () && !settings.method.activePriors ().proposals)
    throw UsageError ("--proposal has no effect: --priors or --preset turn the prior proposals off");
  settings.method.compute_hull = settings.save_hull;
  settings.method.compute_bounds = settings.save_bounds;
  settings.constraints = constraintsOf (settings.method);
  setPlanes (settings);
  settings.reading.threads = settings.method.threads;
  settings.reading.max_memory_bytes = settings.method.max_memory_bytes;
  if (settings.segment && settings.inputs.size () > 1)
    throw UsageError ("--segment needs one INPUT: objects of several have no common numbers");
  if (settings.segment && (!settings.reading.label_field.empty () || !settings.reading.background_labels.empty () ||
                           !settings.reading.ignored_labels.empty ()))
    throw UsageError ("--segment makes labels of its own, and goes with none of --label-field, --background, --ignore");
  for (const auto& [is_given, option] : {std::pair (!settings.save_labels.empty (), "--save-labels"),
                                         std::pair (settings.max_object_size_m > 0.0, "--max-object-size")})
    if (is_given && !settings.segment)
      throw UsageError (std::string (option) + " needs --segment");
  if (settings.max_object_size_m > 0.0 && settings.max_object_size_m <= ObjectSegmentationOptions ().min_object_size_m)
    throw UsageError ("--max-object-size must be more than the shortest object has; pcl_cosection_segment has "
                      "--min-object-size, too");
  if (!settings.save_labels.empty () && !endsWith (settings.save_labels, ".pcd"))
    throw UsageError ("--save-labels is \"" + settings.save_labels + "\"; it must be the name of a .pcd file");
  std::vector<std::string> inputs = settings.inputs;
  inputs.push_back (configurationFile (settings.arguments));
  refuseToOverwrite (inputs, {settings.save_labels});
  if (settings.axes == "opengl")
    settings.reading.axes = SensorAxes::OpenGl;
  for (const Eigen::Vector4d& plane : settings.planes)
    settings.reading.planes.push_back ({plane[0], plane[1], plane[2], plane[3]});
  setViewpoints (settings);
  settings.reading.intrinsics = parseIntrinsics (settings.intrinsics);
}

} // namespace

const ProgramText&
completionText ()
{
  static const ProgramText text = {
      "pcl_cosection",
      "complete the hidden surfaces of objects in point clouds",
      "pcl_cosection [OPTIONS] INPUT [INPUT ...] OUTPUT",
      "Completes the hidden surfaces of objects in point clouds: closed meshes that keep clear of seen free space and "
      "of each other.",
      {"INPUT is a view, a PCD or PLY file: points in the sensor frame; VIEWPOINT of the header is the pose of the "
       "sensor. An "
       "integer field \"label\" says which object a point belongs to, 0 is the background; without it, everything is "
       "object 1. "
       "Organised clouds, and others that were seen from their viewpoint, also show which space is free.",
       "OUTPUT ending in .ply, .stl or .obj is one file with the meshes of all objects, without the background; "
       "anything else is a folder for background.ply and object_LABEL.ply. Meshes are in metres, in the world frame, "
       "or in the frame of an object that has a trajectory."},
      {
          {"pcl_cosection table.pcd meshes",
           "every labelled object of one organised view, and the table, into the folder meshes"},
          {"pcl_cosection --segment table.pcd found", "what stands on the table, found first, whatever the labels"},
          {"pcl_cosection front.pcd left.pcd cup.ply",
           "one object seen in two views (VIEWPOINT in each header), as one closed mesh"},
          {"pcl_cosection --free-space other.pcd table.pcd carved",
           "one labelled view, and what another one, without labels, saw free"},
          {"pcl_cosection --plane 0,0,1,0 --voxel-size 0.003 cropped.pcd cup.stl",
           "what stands on a known plane, z = 0 in the world, with voxels of 3 mm"},
          {"pcl_cosection --obstacle shelf.off --max-faces 2000 cropped.pcd cup.obj",
           "what stands in a shelf whose model is known, in a mesh of 2000 triangles"},
          {"pcl_cosection --scale 0.001 --save-bounds scan_mm.pcd part.ply",
           "a scan in millimetres; also part_inner.ply and part_outer.ply"},
          {"pcl_cosection --preset paper --constraints hull --json s.json table.pcd out",
           "the parameters of the publication, without the intersection constraint"},
      },
      {"voxel-size = 0.004", "plane = [0, 0, 1, 0.72]"},
  };
  return (text);
}

void
declareOptions (CLI::App& app, Given& given)
{
  declareInput (app, given);
  declareLabels (app, given);
  declareSurroundings (app, given);
  declareVolumeOptions (app, given, "twice the smallest object's");
  declareMethodOptions (app, given);
  OptionGroup (app, "Method")
      .add ("--model FILE.onnx", given.model, "Network of the learned prior (default: the installed one)");
  declareOutput (app, given);
  declareGeneralOptions (app, "pcl_cosection", given);
}

std::string
meshExtension (const std::string& path)
{
  const std::string extension = lowerCaseExtension (path);
  return (extension == ".ply" || extension == ".stl" || extension == ".obj" ? extension.substr (1) : "");
}

std::optional<Settings>
parseCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<Settings> (argc, argv, completionText (), declareOptions, interpret));
}
