// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hull_scene.h"

#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/convex_hull_mesh.h"

#include <string>

namespace pcl::cosection::test {

PhysicalScene
sceneOfHulls (const SurfacePoints& points, double density_kg_m3, const PhysicalScene& like)
{
  PhysicalScene scene;
  scene.T_result_scene = like.T_result_scene;
  scene.gravity = like.gravity;
  scene.planes = like.planes;
  const Eigen::Isometry3d T_scene_result = like.T_result_scene.inverse ();
  for (const auto& [id, of_object] : points)
  {
    std::vector<Eigen::Vector3d> in_scene;
    for (const Eigen::Vector3f& p : of_object)
      in_scene.push_back (T_scene_result * p.cast<double> ());
    const TriangleMesh hull = convexHullOf (in_scene).mesh ();
    const MassProperties mass = hull.empty () ? MassProperties () : computeMassProperties (hull);
    if (!(mass.volume_m3 > 0.0))
      continue;
    PhysicalBody body;
    body.name = "object_" + std::to_string (id);
    body.id = id;
    body.T_scene_body.translation () = mass.centroid_m;
    body.visual = movedMesh (hull, body.T_scene_body.inverse ());
    body.parts = {body.visual};
    body.volume_m3 = body.parts_volume_m3 = mass.volume_m3;
    body.mass_kg = density_kg_m3 * mass.volume_m3;
    body.inertia = density_kg_m3 * mass.inertia;
    scene.bodies.push_back (std::move (body));
  }
  return scene;
}

} // namespace pcl::cosection::test
