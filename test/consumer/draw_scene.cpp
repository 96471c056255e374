// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Draws a tetrahedron on its way, without a display, and says why there is no window where there is none.

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/visualization/run_window.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <cstdlib>
#include <iostream>

using namespace pcl::cosection;

int
main ()
{
  RunScene scene;
  SceneRecord::Object tetrahedron;
  tetrahedron.id = 1;
  tetrahedron.name = "1";
  tetrahedron.mesh.vertices = {{0.0f, 0.0f, 0.0f}, {0.2f, 0.0f, 0.0f}, {0.0f, 0.2f, 0.0f}, {0.0f, 0.0f, 0.2f}};
  tetrahedron.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (int frame = 0; frame < 3; ++frame)
  {
    StampedPose pose;
    pose.stamp = frame;
    scene.run.camera.push_back (pose);
    pose.pose.translation () << 0.1 * frame, 0.0, 1.0;
    tetrahedron.poses.push_back (pose);
  }
  scene.run.objects.push_back (tetrahedron);
  SceneView view;
  view.viewpoint = overview (scene);
  const Picture picture = drawScene (scene, 2.0, view);

  unsetenv ("DISPLAY");
  try
  {
    requireDisplay ();
    return (1);
  }
  catch (const IoError& error)
  {
    std::cout << "drew " << picture.width << " x " << picture.height << " pixels; " << error.what () << std::endl;
  }
  return (0);
}
