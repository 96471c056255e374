// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_text.h"

const ProgramText&
evaluationText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate",
      "compare reconstructed meshes and trajectories with the truth",
      "pcl_cosection_evaluate mesh|trajectory [OPTIONS] TRUTH ESTIMATE\n       pcl_cosection_evaluate run [OPTIONS] "
      "OUTPUT DATASET",
      "Compares reconstructed meshes, trajectories and whole runs with the truth.",
      {"Lengths are in metres in options, JSON and CSV, and in millimetres on the terminal. An unknown command, file "
       "or "
       "option is refused; what cannot be measured is said."},
      {
          {"pcl_cosection_evaluate mesh truth.ply cup.ply", "how near a mesh is to the true one"},
          {"pcl_cosection_evaluate trajectory groundtruth.txt camera.txt", "how near a trajectory is to the true one"},
          {"pcl_cosection_evaluate run output dataset", "all objects, the camera and the background of a run"},
      },
      {"f-threshold = 0.005", "threads = 2"},
  };
  return (text);
}

const ProgramText&
meshText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate mesh",
      "accuracy, completeness, F-score and topology of a mesh",
      "pcl_cosection_evaluate mesh [OPTIONS] TRUTH RECONSTRUCTION",
      "Compares a reconstructed mesh with the true one.",
      {"Accuracy is the mean distance of points of the reconstruction to the truth, completeness that of points of the "
       "truth to "
       "the reconstruction: points are uniform by area, distances exact. Both meshes are in one frame and in metres: "
       ".ply, "
       ".stl, .obj, .off, .vtk or .vtp. They may be open; the volume is that of closed meshes."},
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

const ProgramText&
trajectoryText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate trajectory",
      "absolute and relative errors of a trajectory (ATE, RPE)",
      "pcl_cosection_evaluate trajectory [OPTIONS] TRUTH ESTIMATE",
      "Compares an estimated trajectory with the true one.",
      {"Both files have a line \"stamp tx ty tz qx qy qz qw\" for each pose, as in the TUM RGB-D benchmark. The "
       "absolute "
       "trajectory error (ATE) is the distance of aligned positions, the relative pose error (RPE) that of motions "
       "between "
       "poses."},
      {
          {"pcl_cosection_evaluate trajectory groundtruth.txt camera.txt", "the table on the terminal"},
          {"pcl_cosection_evaluate trajectory --delta 30 groundtruth.txt camera.txt", "with the drift over 30 poses"},
      },
      {"max-difference = 0.02", "delta = 30"},
  };
  return (text);
}

const ProgramText&
runText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate run",
      "meshes, trajectories and penetration of a whole run",
      "pcl_cosection_evaluate run [OPTIONS] OUTPUT DATASET",
      "Compares a run on a sequence, poses and meshes of moving objects, with the truth of its dataset.",
      {"OUTPUT has trajectory/camera.txt, trajectory/object_ID.txt, mesh/object_ID.ply and mesh/background.ply. "
       "DATASET has "
       "gt-cam-0.txt, gt-NAME-ID.txt, gt-mesh/NAME.ply, gt-mesh/room.ply (or background.ply) and calibration.txt.",
       "The world and the frames of objects may differ: objects are matched by their overlap in the camera's frame and "
       "aligned "
       "by the median of their poses, refined on the observed surface. What is missing is said, the rest is "
       "evaluated."},
      {
          {"pcl_cosection_evaluate run output dataset", "the table on the terminal"},
          {"pcl_cosection_evaluate run --json run.json output dataset", "all numbers for programs"},
      },
      {"refine = none", "json = run.json"},
  };
  return (text);
}
