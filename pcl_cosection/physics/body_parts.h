// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/convex_hull_mesh.h"
#include "pcl_cosection/physics/scene_builder.h"

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The mesh that a body's parts are made of, scene frame. */
struct CollisionSource
{
  std::string name;      ///< of the object, for messages
  TriangleMesh mesh;     ///< with a flat bottom
  TriangleMesh estimate; ///< as it was
  double voxel_size_m = 0.0;
  bool extended = false; ///< down to what it stands on
};

/** \brief What a body collides by, scene frame. */
struct BodyParts
{
  std::vector<ConvexHull> hulls;
  bool touches_others = false; ///< another body is within two voxels
  double overlap_m = 0.0;      ///< with another body's, where no cut leaves something of both
};

/** \brief Divide all bodies into convex parts that hardly overlap those of others. */
std::vector<BodyParts> divideBodies (const std::vector<CollisionSource>& sources, const PhysicsOptions& options);

/** \brief Hand a body its parts, and say how well they fit. */
void setParts (const BodyParts& parts, const CollisionSource& source, const PhysicsOptions& options,
               PhysicalBody& body);

} // namespace pcl::cosection
