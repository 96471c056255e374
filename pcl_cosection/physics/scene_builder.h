// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <map>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What objects collide by. */
enum class CollisionShape
{
  Hull,  ///< the convex hull
  Parts, ///< several convex parts
  Mesh,  ///< the mesh itself, for simulators that can
  Outer, ///< parts of the outer bound: everything that may be the object
};

/** \brief Where the exported scene's frame is. */
enum class SceneFrame
{
  Auto,   ///< as Result if its z axis points up, else as Table
  Result, ///< that of the result
  Table,  ///< the origin on the support plane, below the objects, z up
};

/** \brief What is to be made of completed objects. */
struct PhysicsOptions
{
  double density_kg_m3 = 500.0;
  std::map<int, double> masses_kg; ///< by object, instead of the density
  CollisionShape collision = CollisionShape::Parts;
  int max_parts = 16; ///< of an object
  SceneFrame frame = SceneFrame::Auto;
  double contact_tolerance_m = 0.0002; ///< parts of two bodies may overlap by so much
  int threads = 0;                     ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief A completed object. */
struct CompletedObject
{
  int id = 0;
  std::string label;         ///< its class; empty: not known
  TriangleMesh mesh;         ///< closed, object frame
  TriangleMesh outer;        ///< the outer bound; empty: not known
  double voxel_size_m = 0.0; ///< of the estimate
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity ();
};

/** \brief What a completion found. */
struct CompletedScene
{
  std::vector<CompletedObject> objects;
  TriangleMesh background;             ///< open, world frame; may be empty
  std::vector<Eigen::Vector4d> planes; ///< support planes n.x + d = 0, unit n towards the objects, world frame
};

/** \brief Make rigid bodies of completed objects and of what they stand on.
 *
 * - Masses, centres and inertia are those of the meshes (divergence theorem).
 * - What an object collides by has a flat bottom where it stands: what is within a voxel of the plane lies on it.
 * - The centre of mass of an object that stands, and touches nothing else, is moved over what it stands on, if it is
 *   not there: what stands in truth stands.
 * - Parts of two objects overlap by no more than the tolerance: they are divided where others are in their hollows, and
 *   what still overlaps is cut by the plane along which they overlap least.
 * \throws InvalidArgument if an option is out of its domain, or there is no object; the message names an object whose
 * mesh is not closed, or has no outer bound where that is asked for */
PhysicalScene buildPhysicalScene (const CompletedScene& scene, const PhysicsOptions& options);

} // namespace pcl::cosection
