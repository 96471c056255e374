// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_table.h"

#include "arguments.h"
#include "option_values.h"

using namespace pcl::cosection;

namespace {

void
declareInput (CLI::App& app, Given& given)
{
  const std::string group = "Input";
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  app.add_flag ("--world-points", given.world_points, "Points are in the world frame already")->group (group);
  app.add_option ("--viewpoint", given.viewpoints,
                  "Where the sensor stood, for points in the world frame whose header does not say it; once for all "
                  "views, or once for each")
      ->option_text ("X,Y,Z")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option ("--intrinsics", given.intrinsics, "Camera in pixels, for organised clouds that no pinhole fits")
      ->option_text ("FX,FY,CX,CY")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option ("--scale", given.scale, "Multiplies all coordinates: 0.001 for millimetres")
      ->option_text ("FACTOR")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--object-trajectory", given.object_trajectories,
                  "Poses of object ID in the world, for views in which it moved: "
                  "lines \"view tx ty tz qx qy qz qw\", views from 0; repeatable")
      ->option_text ("ID=FILE")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option ("--free-space", given.free_space,
                  "View that shows which space is free and nothing else: its labels and points are not used; "
                  "numbered after the INPUTs; repeatable")
      ->option_text ("VIEW.pcd")
      ->allow_extra_args (false)
      ->group (group);
}

void
declareSurroundings (CLI::App& app, Given& given)
{
  const std::string group = "Surroundings";
  app.add_option ("--plane", given.planes,
                  "Plane a x + b y + c z + d = 0 (world, metres) that no object "
                  "crosses: a table, a wall; repeatable")
      ->option_text ("A,B,C,D")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option ("--obstacle", given.obstacles,
                  "Mesh (world, metres) that no object enters: .ply, .stl, "
                  ".obj, .off, .vtk or .vtp; repeatable")
      ->option_text ("MESH")
      ->allow_extra_args (false)
      ->group (group);
  app.add_flag ("--no-planes", given.no_planes, "Do not look for support planes in the background, nor guess them")
      ->group (group);
}

void
declareOutput (CLI::App& app, Given& given)
{
  const std::string output = "Output";
  app.add_option ("--format", given.format, "Format of the meshes in a folder" + byDefault ("ply"))
      ->option_text ("ply|stl|obj")
      ->check (oneOf ({"ply", "stl", "obj"}))
      ->group (output);
  app.add_option ("--max-faces", given.max_faces, "Simplify each mesh to at most so many triangles, still closed")
      ->option_text ("N")
      ->check (wholeRange (4, 2147483647))
      ->group (output);
  app.add_flag ("--save-hull", given.save_hull,
                "Write each object's hull: all that may be it, as no view "
                "saw it free (_hull)")
      ->group (output);
  app.add_flag ("--save-bounds", given.save_bounds,
                "Write bounds for collision checks: matter surely there "
                "(_inner), and the mesh with its hull (_outer)")
      ->group (output);
  app.add_flag ("--save-sdf", given.save_sdf, "Write each object's signed distance beside its mesh (.vti)")
      ->group (output);
  app.add_option ("--json", given.json, "Write a summary for programs")->option_text ("FILE")->group (output);

  const std::string general = "General";
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group (general);
  declareGeneralOptions (app, "pcl_cosection", given.verbose, given.quiet);
}

} // namespace

void
declareOptions (CLI::App& app, Given& given)
{
  declareInput (app, given);
  declareSurroundings (app, given);
  declareVolumeOptions (app, given, "twice the smallest object's");
  declareMethodOptions (app, given);
  declareOutput (app, given);
}
