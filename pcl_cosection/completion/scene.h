// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_energy.h"
#include "pcl_cosection/energy/data/shape_evidence.h"
#include <pcl/cosection/surface/co_section.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
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
struct UsedView
{
  DepthView depth;
  ViewUse use = ViewUse::Full;
};

/** \brief Everything that a user has added to a CoSection. */
struct Scene
{
  CoSectionOptions options;
  std::vector<UsedView> views;
  std::vector<OrientedPoint> background; // world frame
  std::vector<ObjectInput> objects;
  std::vector<Eigen::Vector4d> planes; // unit normals, world frame
  std::vector<Obstacle> obstacles;
  std::vector<MeshObstacle> mesh_obstacles;
  std::map<int, std::vector<Eigen::Isometry3d>> poses; // T_world_object by object, as given with views
  std::map<int, std::vector<PointBatch>> batches;      // by object; 0: the background

  ObjectInput* find (int id);

  void countBatch (int id, std::size_t points)
  {
    batches[id].push_back ({static_cast<int> (views.size ()) - 1, points});
  }

  /** \brief Whether there is no background, plane or obstacle. */
  bool hasNothingAround () const
  {
    return planes.empty () && background.empty () && obstacles.empty () && mesh_obstacles.empty ();
  }

  /** \brief Whether the options give a voxel size or a resolution for objects. */
  bool fixedVoxelSize () const { return options.voxel_size_m > 0.0 || options.resolution > 0; }
};

/** \brief How a scene is completed. */
enum class CompletionMode
{
  Once,        ///< evidence is freed after use
  Incremental, ///< the state is kept for the next update
};

/** \brief The state of one body between updates: its grid, the evidence of the points and views read so far, and the
 * last solution. */
struct BodyState
{
  std::optional<VoxelGrid> grid;
  CoSectionOptions options;                // of the scene, with the body's own Gaussians and tolerance
  std::unique_ptr<ShapeEvidence> evidence; // null before there is a grid, and after use in the mode Once
  BodySolution solution;
  double wall_m = 0.0;          // wall thickness of a vessel; 0 for other shapes
  int updates_without_wall = 0; // since the last one that found a wall
  std::size_t points_read = 0;
  std::size_t views_read = 0;
  std::vector<bool> outliers; // whether a point is left out; for the points of the last update

  /** \brief Change the grid and read everything again. The solution is kept as a start if the lattice is the same. */
  void restart (const VoxelGrid& new_grid, const CoSectionOptions& new_options, bool carve);

  /** \brief Read all points and views again; the grid and the solution stay. */
  void readAgain ();

  /** \brief Read all points again. */
  void readPointsAgain ();
};

/** \brief A part of a background that is too large for one volume. Boxes are of voxels of the blocks' lattice; both
 * ends belong to them. */
struct BackgroundBlock
{
  Eigen::AlignedBox3i core;   // the voxels whose values are this block's
  Eigen::AlignedBox3i domain; // those in which it is solved: with a margin in which blocks overlap
  BodyState body;             // on the domain; its evidence has the views' votes, and points only while they are needed
  std::vector<bool> free_space; // of the domain, when it was last solved
  std::vector<std::size_t>
      seam; // voxels of the domain beside the core and near data, where its neighbours' fields count
  bool has_data = false;
  bool is_current = false;   // solved with its evidence and its neighbours' fields
  SolverSummary solver;      // of the last solve
  double solved_share = 0.0; // in this completion
};

/** \brief A background in overlapping blocks; none if one volume is enough. */
struct BackgroundBlocks
{
  double voxel_size_m = 0.0;                            // 0: there are no blocks
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero ();  // centre of voxel (0, 0, 0) of the lattice, world frame
  int core_edge = 0;                                    // voxels
  int margin = 0;                                       // voxels by which a block's volume reaches into others
  Eigen::AlignedBox3i whole;                            // the voxels of the background
  std::map<std::array<int, 3>, BackgroundBlock> blocks; // those with data near; by core.min () / core_edge: z, y, x
  std::vector<PlaneContinuation> planes;                // of the last completion

  /** \brief Read all points and views again; the solution stays as a start. */
  void readAgain ();
};

/** \brief The incremental state of a scene, kept from one update to the next. */
struct SceneState
{
  std::map<int, BodyState> objects; // by id
  BodyState background;             // if all of it is completed; with blocks, on coarser voxels
  BackgroundBlocks blocks;          // of the background, if one volume is too small for its voxels
  std::set<int> without_proposals;  // objects whose proposals do not count
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
