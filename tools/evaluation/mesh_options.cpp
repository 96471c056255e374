// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_command.h"
#include "option_values.h"

void
declareMeshOptions (CLI::App& app, MeshSettings& settings)
{
  const std::string comparison = "Comparison";
  app.add_option ("--samples", settings.samples, "Points on each mesh" + byDefault (settings.samples))
      ->option_text ("N")
      ->check (wholeRange (1, 100000000))
      ->group (comparison);
  app.add_option ("--seed", settings.seed, "Of the points: the same seed, the same points" + byDefault (0))
      ->option_text ("N")
      ->check (wholeRange (0, std::numeric_limits<long>::max ()))
      ->group (comparison);
  app.add_option ("--f-threshold", settings.f_threshold_m,
                  "Distance up to which a point counts for precision, recall and F-score" +
                      byDefault (settings.f_threshold_m))
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (comparison);
  app.add_option ("--pose", settings.pose,
                  "Pose of the reconstruction in the frame of the truth (default: the same frame)")
      ->option_text ("TX,TY,TZ,QX,QY,QZ,QW")
      ->allow_extra_args (false)
      ->group (comparison);
  app.add_option ("--align", settings.align, "Refine the pose, by point-to-plane ICP, before comparing (default: none)")
      ->option_text ("none|icp")
      ->check (CLI::IsMember (std::vector<std::string>{"none", "icp"}))
      ->group (comparison);

  const std::string surroundings = "Surroundings";
  app.add_option ("--obstacle", settings.obstacles,
                  "Mesh (frame of the truth) that the reconstruction should not enter; repeatable")
      ->option_text ("MESH")
      ->allow_extra_args (false)
      ->group (surroundings);
  app.add_option ("--penetration-voxel", settings.penetration_voxel_m,
                  "Voxels of the volume inside obstacles (default: 1/128 of the smaller box)")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (surroundings);
  app.add_option ("--free-space", settings.views,
                  "Organised PCD view whose VIEWPOINT is the sensor in the frame of the truth: no surface should be "
                  "in front of what it measured; repeatable")
      ->option_text ("VIEW.pcd")
      ->allow_extra_args (false)
      ->group (surroundings);
  app.add_option ("--free-space-tolerance", settings.free_space_tolerance_m,
                  "How far in front is no violation" + byDefault (settings.free_space_tolerance_m))
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited))
      ->group (surroundings);

  const std::string output = "Output";
  app.add_option ("--error-picture", settings.error_picture,
                  "Draw both meshes, coloured by their distance to each other")
      ->option_text ("FILE.png")
      ->group (output);
  app.add_option ("--error-mesh", settings.error_mesh,
                  "Write the reconstruction, its vertices coloured by their distance to the truth")
      ->option_text ("FILE.ply")
      ->group (output);
  app.add_option ("--error-max", settings.error_max_m,
                  "Error at the red end of the colours (default: where 95 % of both meshes are below, rounded up)")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (output);
  app.add_option ("--up", settings.up, "What points up in the picture (default: 0,0,1)")
      ->option_text ("X,Y,Z")
      ->allow_extra_args (false)
      ->group (output);
  declareCommonOptions (app, settings.common);
}
