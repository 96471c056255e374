// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"
#include "evaluation/moving_scene.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <filesystem>
#include <string>

namespace pcl::cosection::test {

/** \brief Write a scene as pcl_cosection_fusion does; as TSDF, the upper part of each object. */
inline void
writeRun (const SceneRecord& scene, const std::string& folder)
{
  const std::filesystem::path path (folder);
  std::filesystem::create_directories (path / "mesh");
  std::filesystem::create_directories (path / "trajectory");
  saveTrajectory (scene.camera, (path / "trajectory" / "camera.txt").string ());
  saveMesh (scene.background, (path / "mesh" / "background.ply").string ());
  for (const SceneRecord::Object& object : scene.objects)
  {
    const std::string name = "object_" + std::to_string (object.id);
    saveTrajectory (object.poses, (path / "trajectory" / (name + ".txt")).string ());
    saveMesh (object.mesh, (path / "mesh" / (name + ".ply")).string ());
    saveMesh (upperPart (object.mesh), (path / "mesh" / (name + "_tsdf.ply")).string ());
  }
  writeFile ((path / "summary.json").string (),
             R"({"camera": {"width": 320, "height": 240, "fx": 260, "fy": 260, "cx": 159.5, "cy": 119.5},)"
             R"( "parameters": {"dataset": "images", "images": {"format": "tum", "depth_scale": 5000.0}}})");
}

/** \brief A torus and a box before a floor (moving_scene.h), as a run has them; the box is not known from frame 12 on.
 */
inline RunScene
movingRun ()
{
  RunScene scene;
  scene.folder = "run";
  scene.run = movingScene ();
  scene.run.objects[1].poses.resize (12);
  for (const SceneRecord::Object& object : scene.run.objects)
    scene.tsdf[object.id] = upperPart (object.mesh);
  return scene;
}

} // namespace pcl::cosection::test
