// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_meshes.h"

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

namespace pcl::cosection::test {

/** \brief A torus and a box before a floor, both in motion, and a camera that circles around them; 24 frames. */
inline SceneRecord
movingScene ()
{
  SceneRecord scene;
  scene.intrinsics = PinholeCamera{320, 240, 260.0, 260.0, 159.5, 119.5};
  scene.background = planeMesh (2.0, 8);
  for (auto& v : scene.background.vertices)
    v -= Eigen::Vector3f (1.0f, 1.0f, 0.0f);
  SceneRecord::Object torus, box;
  torus.id = 1;
  torus.name = "torus";
  torus.mesh = torusMesh (0.12, 0.05, 48, 24);
  box.id = 2;
  box.name = "box";
  box.mesh = boxMesh ({-0.1f, -0.06f, -0.04f}, {0.1f, 0.06f, 0.04f});
  for (int n = 0; n < 24; ++n)
  {
    const double t = n / 24.0;
    const Eigen::Vector3d eye (1.2 * std::cos (t), 1.2 * std::sin (t) - 0.3, 0.8 + 0.1 * std::sin (7.0 * t));
    scene.camera.push_back ({1.0 * n, lookAt (eye, Eigen::Vector3d::Zero ())});
    torus.poses.push_back ({1.0 * n, motion (1.5 * t, {1.0, 0.5, 2.0}, {-0.25 + 0.2 * t, 0.0, 0.3})});
    box.poses.push_back ({1.0 * n, motion (-t, {0.0, 0.0, 1.0}, {0.3, 0.3 * t - 0.1, 0.05})});
  }
  scene.objects = {torus, box};
  return scene;
}

/** \brief The scene as a system would estimate it without any error: the world is the first camera, the objects have
 * other frames and ids, the order is another. */
inline SceneRecord
inOtherFrames (const SceneRecord& truth)
{
  SceneRecord estimate;
  const Eigen::Isometry3d T_estimate_world = truth.camera.front ().pose.inverse ();
  for (const StampedPose& pose : truth.camera)
    estimate.camera.push_back ({pose.stamp, T_estimate_world * pose.pose});
  estimate.background = transformMesh (truth.background, T_estimate_world);
  int id = 7;
  for (auto object = truth.objects.rbegin (); object != truth.objects.rend (); ++object, ++id)
  {
    const Eigen::Isometry3d T_frame_object = motion (0.4 + id, {1.0, 0.3 * id, -0.5}, {0.2, -0.1, 0.05 * id});
    SceneRecord::Object other;
    other.id = id;
    other.name = std::to_string (id);
    other.mesh = transformMesh (object->mesh, T_frame_object);
    for (const StampedPose& pose : object->poses)
      other.poses.push_back ({pose.stamp, T_estimate_world * pose.pose * T_frame_object.inverse ()});
    estimate.objects.push_back (other);
  }
  return estimate;
}

} // namespace pcl::cosection::test
