// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/small_meshes.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/convex_hull_mesh.h"
#include "pcl_cosection/physics/scene_builder.h"

#include <pcl/cosection/simulation/simulated_scene.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

constexpr double chord_m = 0.0002;     ///< of round things from their meshes
constexpr double test_voxel_m = 0.002; ///< said to be that of the estimates
constexpr double angle_leg_m = 0.1;    ///< of angleMesh ()
constexpr double angle_wall_m = 0.03;  ///< of angleMesh ()
constexpr double angle_width_m = 0.05; ///< of angleMesh ()
constexpr double cup_radius_m = 0.04;  ///< outer, of cupMesh ()
constexpr double cup_height_m = 0.09;  ///< of cupMesh ()
constexpr double cup_wall_m = 0.006;   ///< of cupMesh ()
const Eigen::Vector4d floor_plane (0.0, 0.0, 1.0, 0.0);

/** \brief As shapes come from files without normals. */
inline TriangleMesh
withoutNormals (TriangleMesh mesh)
{
  mesh.normals.clear ();
  return mesh;
}

/** \brief About z, standing on z = 0. */
inline TriangleMesh
canMesh (double radius, double height, double chord = chord_m)
{
  return makeCylinder (radius, height)->tessellate (chord);
}

/** \brief An L in the plane of x and z, from x = y = z = 0: one leg lies on z = 0, the other is at x = 0. */
inline TriangleMesh
angleMesh ()
{
  const double leg = angle_leg_m, wall = angle_wall_m;
  const Shape::ConstPtr shape = makeExtrusion ({{0, 0}, {leg, 0}, {leg, wall}, {wall, wall}, {wall, leg}, {0, leg}},
                                               angle_width_m);
  const Eigen::Isometry3d T (Eigen::Translation3d (0.0, angle_width_m, 0.0) *
                             Eigen::AngleAxisd (M_PI_2, Eigen::Vector3d::UnitX ()));
  return movedMesh (withoutNormals (shape->tessellate (chord_m)), T);
}

/** \brief Open at the top, about z, standing on z = 0. */
inline TriangleMesh
cupMesh ()
{
  const double inner = cup_radius_m - cup_wall_m;
  return makeRevolution ({{0, 0},
                          {cup_radius_m, 0},
                          {cup_radius_m, cup_height_m},
                          {inner, cup_height_m},
                          {inner, cup_wall_m},
                          {0, cup_wall_m}})
      ->tessellate (chord_m);
}

/** \brief An arm on a leg at its end, from x = y = z = 0: the centre of mass is 13 mm beside the leg. */
inline TriangleMesh
overhangingMesh ()
{
  const Eigen::Isometry3d T (Eigen::Translation3d (0.0, 0.05, 0.0) *
                             Eigen::AngleAxisd (M_PI_2, Eigen::Vector3d::UnitX ()));
  const Polygon2d outline = {{0, 0}, {0.03, 0}, {0.03, 0.07}, {0.12, 0.07}, {0.12, 0.1}, {0, 0.1}};
  return movedMesh (withoutNormals (makeExtrusion (outline, 0.05)->tessellate (chord_m)), T);
}

inline CompletedObject
objectOf (int id, const std::string& label, TriangleMesh mesh,
          const Eigen::Isometry3d& T_world_object = Eigen::Isometry3d::Identity ())
{
  CompletedObject object;
  object.id = id;
  object.label = label;
  object.mesh = std::move (mesh);
  object.voxel_size_m = test_voxel_m;
  object.T_world_object = T_world_object;
  return object;
}

/** \brief Objects on z = 0. */
inline CompletedScene
sceneOf (std::vector<CompletedObject> objects)
{
  CompletedScene scene;
  scene.objects = std::move (objects);
  scene.planes = {floor_plane};
  return scene;
}

/** \brief Turned about z, and moved along the plane. */
inline Eigen::Isometry3d
placeAt (double x, double y, double turn_rad)
{
  return Eigen::Translation3d (x, y, 0.0) * Eigen::AngleAxisd (turn_rad, Eigen::Vector3d::UnitZ ());
}

/** \brief A box, a can, an L and a cup that stand apart on z = 0. */
inline CompletedScene
fourThings ()
{
  return sceneOf ({objectOf (1, "box", boxMesh ({-0.05f, -0.04f, 0.0f}, {0.05f, 0.04f, 0.06f}), placeAt (0, 0, 0.3)),
                   objectOf (2, "can", canMesh (0.033, 0.12), placeAt (0.2, 0.05, 1.0)),
                   objectOf (3, "angle", angleMesh (), placeAt (-0.2, 0.1, -0.7)),
                   objectOf (4, "cup", cupMesh (), placeAt (0.05, -0.2, 0.2))});
}

/** \brief An L with a box in its corner, and a cup with a ball in it, all of them touching. */
inline CompletedScene
interlockingThings ()
{
  constexpr double ball_m = 0.02;
  const auto wall = static_cast<float> (angle_wall_m);
  return sceneOf ({objectOf (1, "angle", angleMesh ()),
                   objectOf (2, "box", boxMesh ({wall, 0.0f, wall}, {wall + 0.05f, 0.05f, wall + 0.04f})),
                   objectOf (3, "cup", cupMesh (), placeAt (0.3, 0, 0)),
                   objectOf (4, "ball", sphereMesh (ball_m, 20),
                             Eigen::Isometry3d (Eigen::Translation3d (0.3, 0.0, cup_wall_m + ball_m)))});
}

/** \brief Everything of a scene moved. */
inline CompletedScene
movedScene (CompletedScene scene, const Eigen::Isometry3d& T)
{
  for (CompletedObject& object : scene.objects)
    object.T_world_object = T * object.T_world_object;
  for (Eigen::Vector4d& plane : scene.planes)
  {
    const Eigen::Vector3d normal = T.linear () * plane.head<3> ();
    plane << normal, plane[3] - normal.dot (T.translation ());
  }
  return scene;
}

/** \brief The parts of a body, in the frame of the scene. */
inline std::vector<ConvexHull>
hullsOf (const PhysicalBody& body)
{
  std::vector<ConvexHull> hulls;
  for (const TriangleMesh& part : body.parts)
  {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3f& vertex : part.vertices)
      points.push_back (body.T_scene_body * vertex.cast<double> ());
    hulls.push_back (convexHullOf (points));
  }
  return hulls;
}

/** \brief How deep a point is in the hull that it is deepest in; negative: outside of all. */
inline double
depthIn (const std::vector<ConvexHull>& hulls, const Eigen::Vector3d& point)
{
  double depth = -std::numeric_limits<double>::infinity ();
  for (const ConvexHull& hull : hulls)
    depth = std::max (depth, hull.depthOf (point));
  return depth;
}

/** \brief How far the vertices of a mesh are outside all hulls, at most; not above zero if they are inside. */
inline double
farthestOutside (const std::vector<ConvexHull>& hulls, const TriangleMesh& mesh, const Eigen::Isometry3d& T)
{
  double farthest = -std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    farthest = std::max (farthest, -depthIn (hulls, T * vertex.cast<double> ()));
  return farthest;
}

} // namespace pcl::cosection::test
