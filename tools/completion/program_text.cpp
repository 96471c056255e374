// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "program_text.h"

const ProgramText&
completionText ()
{
  static const ProgramText text = {
      "pcl_cosection",
      "complete the hidden surfaces of objects in point clouds",
      "pcl_cosection [OPTIONS] INPUT.pcd [INPUT.pcd ...] OUTPUT",
      "Completes the hidden surfaces of objects in point clouds: closed meshes that keep clear of "
      "seen free space and of each other.",
      {"INPUT is a view: points in the sensor frame; VIEWPOINT of the header is the pose of the sensor. An integer "
       "field "
       "\"label\" says which object a point belongs to, 0 is the background; without it, everything is object 1. "
       "Organised "
       "clouds, and others that were seen from their viewpoint, also show which space is free.",
       "OUTPUT ending in .ply, .stl or .obj is one file with the meshes of all objects, without the background; "
       "anything "
       "else is a folder for background.ply and object_LABEL.ply. Meshes are in metres, in the world frame, or in the "
       "frame "
       "of an object that has a trajectory."},
      {
          {"pcl_cosection table.pcd meshes",
           "every labelled object of one organised view, and the table, into the folder meshes"},
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
