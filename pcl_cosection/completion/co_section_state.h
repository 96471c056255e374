// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/energy/data/shape_evidence.h"
#include "pcl_cosection/priors/occlusion_map.h"
#include "shape_volume.h"

#include <pcl/cosection/surface/co_section.h>

#include <map>
#include <memory>
#include <vector>

namespace pcl::cosection
{

/** \brief A body that objects cannot enter. */
struct Obstacle
{
  SignedDistanceField::ConstPtr field;
  std::vector<Eigen::Isometry3d> T_field_world;
};

/** \brief The same, given as a mesh. */
struct MeshObstacle
{
  TriangleMesh mesh;
  std::vector<Eigen::Isometry3d> T_mesh_world;
};

/** \brief So many points were added after a view; -1: before the first. */
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

/** \brief One body as it follows a scene to which more is added: how far its evidence has read the scene's points and
 * views, what it gathered of them, and the shape it had last. */
struct IncrementalState
{
  std::unique_ptr<ShapeEvidence> evidence;
  std::unique_ptr<ShapeVolume> volume;
  OcclusionMap hidden;          // of an object
  double wall_m = 0.0;          // of a vessel; 0: it is none
  int updates_without_wall = 0; // since it was one
  std::size_t points_read = 0;
  std::size_t views_read = 0;
  std::vector<bool> outlier; // which of its points are left out; as many as were known at the last update

  const VoxelGrid& grid () const { return volume->grid (); }

  /** \brief Read everything again, on a grid of the same lattice or another; a shape on the same lattice is kept as a
   * start. */
  void restart (const VoxelGrid& grid, const CoSectionOptions& options, bool carve);

  /** \brief Forget all that was read; the grid and the shape stay. */
  void readAgain ();

  /** \brief Forget what was made of points. */
  void readPointsAgain ();
};

/** \brief What remains from one CoSection::update () to the next. */
struct CoSectionMemory
{
  std::map<int, IncrementalState> objects; // by id
  IncrementalState background;
};

/** \brief What the user has told a CoSection. */
struct CoSection::Impl
{
  CoSectionOptions options;
  std::vector<SceneView> views;
  std::vector<OrientedPoint> background;
  std::vector<ObjectInput> objects;
  std::vector<Eigen::Vector4d> planes; // unit normals
  std::vector<Obstacle> bodies;
  std::vector<MeshObstacle> meshes;
  std::map<int, std::vector<Eigen::Isometry3d>> poses; // T_world_object, as named with views
  std::map<int, std::vector<PointBatch>> batches;      // by object, 0 the background
  CoSectionMemory memory;

  ObjectInput* find (int id);
  void countBatch (int id, std::size_t points);
};

} // namespace pcl::cosection
