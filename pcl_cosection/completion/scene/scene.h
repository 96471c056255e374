// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/co_section.h>

#include <cstddef>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief An obstacle (a given body that objects cannot enter) as a field, at some poses. */
struct Obstacle
{
  SignedDistanceField::ConstPtr field;
  std::vector<Eigen::Isometry3d> T_field_world;
};

/** \brief An obstacle as a mesh, at some poses. */
struct MeshObstacle
{
  TriangleMesh mesh;
  std::vector<Eigen::Isometry3d> T_mesh_world;
};

/** \brief The number of points added after a view; view -1: before the first. */
struct PointBatch
{
  int view;
  std::size_t count;
};

/** \brief A depth view of the scene. */
struct SceneView
{
  DepthView depth;
  ViewUse use = ViewUse::Full;
};

/** \brief Everything that a user has added to a CoSection. */
struct Scene
{
  CoSectionOptions options;
  std::vector<SceneView> views;
  std::vector<OrientedPoint> background; // world frame
  std::vector<ObjectInput> objects;
  std::vector<Eigen::Vector4d> planes; // unit normals, world frame
  std::vector<Obstacle> obstacles;
  std::vector<MeshObstacle> mesh_obstacles;
  std::map<int, std::vector<Eigen::Isometry3d>> poses; // T_world_object by object, as given with views
  std::map<int, std::vector<PointBatch>> batches;      // by object; 0: the background

  ObjectInput* find (int id);
  void countBatch (int id, std::size_t points);

  /** \brief Whether there is no background, plane or obstacle. */
  bool hasNothingAround () const;
};

/** \brief T_world_object at a view; not finite if it is not known. */
Eigen::Isometry3d poseAt (const ObjectInput& object, std::size_t view);

/** \brief The first view in which the pose of an object is known. */
std::size_t firstView (const ObjectInput& object);

Eigen::Isometry3d firstPose (const ObjectInput& object);

/** \brief T_to_of over all views (T_world_of if \a to is null), thinned to motions of more than half a voxel of \a
 * grid, which is in the frame of \a of. */
std::vector<Eigen::Isometry3d> relativePoses (const ObjectInput& of, const VoxelGrid& grid, const ObjectInput* to);

/** \brief A plane n.x + d = 0 in the frame of the target. */
Eigen::Vector4d transformPlane (const Eigen::Vector4d& plane, const Eigen::Isometry3d& T_plane_target);

/** \brief Planes of the world in an object's frame at some poses, except at poses where the object is on the plane's
 * other side, as after a move from the table to the floor.
 * \param[in] center of the observed points, object frame */
std::vector<Eigen::Vector4d> planesAtPoses (const ObjectInput& object, const Eigen::Vector3d& center,
                                            const std::vector<Eigen::Vector4d>& planes,
                                            const std::vector<Eigen::Isometry3d>& T_world_object);

} // namespace pcl::cosection
