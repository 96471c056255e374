// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/simulation/scene_renderer.h>

#include <cmath>
#include <iostream>

using namespace pcl::cosection;

/** \brief A ball one metre in front of a camera. */
int
main ()
{
  SceneBody background, ball;
  background.name = "room";
  ball.name = "ball";
  ball.id = 1;
  ball.parts = {{makeSphere (0.1)}};
  ball.motion = KeyedMotion (Eigen::Isometry3d (Eigen::Translation3d (0.0, 0.0, 1.0)));
  SimulatedScene scene;
  scene.bodies = {background, ball};
  const SimulatedFrame frame = SceneRenderer (scene).render (0.0);
  const TriangleMesh mesh = ball.surface (1e-4);
  std::cout << "depth " << frame.depth.at (320, 240) << " m, error " << compareMeshes (mesh, mesh).accuracy.mean
            << " m\n";
  return (std::abs (frame.depth.at (320, 240) - 0.9f) < 1e-3f ? 0 : 1);
}
