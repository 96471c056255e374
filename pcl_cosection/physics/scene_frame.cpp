// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/scene_frame.h"

#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/object_solid.h"
#include "pcl_cosection/physics/resting.h"

#include <cmath>

namespace pcl::cosection {

namespace {

constexpr double vertical_cosine = 0.9994; // 2 degrees: the z axis of the result points up

/** \brief The plane that most objects stand on; of equals, the one that is most level in the result. */
const Eigen::Vector4d&
mainPlane (const CompletedScene& scene)
{
  std::size_t best = 0;
  double best_score = -1.0;
  for (std::size_t n = 0; n < scene.planes.size (); ++n)
  {
    double score = 0.25 * (1.0 + scene.planes[n].z ());
    for (const CompletedObject& object : scene.objects)
    {
      TriangleMesh positions;
      positions.vertices = object.mesh.vertices;
      const double gap = lowestOver (scene.planes[n], movedMesh (positions, object.T_world_object));
      score += std::abs (gap) < touching_voxels * voxelSizeOf (object) ? 1.0 : 0.0;
    }
    if (score > best_score)
    {
      best_score = score;
      best = n;
    }
  }
  return scene.planes[best];
}

} // namespace

FrameOfScene
frameOfScene (const CompletedScene& scene, SceneFrame frame)
{
  FrameOfScene result;
  if (scene.planes.empty ())
    return result;
  const Eigen::Vector4d& plane = mainPlane (scene);
  const Eigen::Vector3d up = plane.head<3> ();
  if (frame == SceneFrame::Result || (frame == SceneFrame::Auto && up.z () > vertical_cosine))
  {
    result.up = up;
    return result;
  }
  Eigen::AlignedBox3d box;
  for (const CompletedObject& object : scene.objects)
    for (const Eigen::Vector3f& vertex : object.mesh.vertices)
      box.extend (object.T_world_object * vertex.cast<double> ());
  const Eigen::Vector3d foot = box.center () - (up.dot (box.center ()) + plane[3]) * up;
  // The x axis is that of the result, as far as it is level; where it is vertical, the y axis.
  const Eigen::Vector3d ahead = std::abs (up.x ()) < 0.9 ? Eigen::Vector3d::UnitX () : Eigen::Vector3d::UnitY ();
  const Eigen::Vector3d x = (ahead - up.dot (ahead) * up).normalized ();
  result.T_world_scene.linear () << x, up.cross (x), up;
  result.T_world_scene.translation () = foot;
  return result;
}

} // namespace pcl::cosection
