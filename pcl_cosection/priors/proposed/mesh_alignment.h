// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/occlusion_map.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief What a mesh is aligned with, in the object's frame, metres. */
struct AlignmentTarget
{
  const std::vector<OrientedPoint>& points;
  const OcclusionMap::Views& views;            ///< what they see free is not of the object
  const OcclusionMap& hidden;                  ///< where other things hide the object
  const std::vector<Eigen::Vector4d>& resting; ///< planes on which it rests: n.x + d = 0, unit n towards it
  double noise_m;                              ///< how far points may be from the surface
};

/** \brief A mesh moved, turned and scaled onto an object. */
struct MeshAlignment
{
  Eigen::Affine3d T_object_mesh = Eigen::Affine3d::Identity (); ///< a rotation, one scale, a translation
  double scale = 1.0;
  double distance_m = 0.0;   ///< median distance of the points from the mesh
  double explained = 0.0;    ///< share of the points that are near the mesh, and face as it does
  double confirmed = 0.0;    ///< share of the mesh's surface that the views should see which is near points
  double contradicted = 0.0; ///< share of the mesh's surface that is in seen free space, or below a plane
};

/** \brief Find the pose and the scale of a mesh at which it explains an object's points and does not contradict what
 * was seen: from many rotations, by iterative closest points in both directions (P. J. Besl, N. D. McKay, PAMI 1992;
 * with a scale: T. Zinsser, J. Schmidt, H. Niemann, 2005). Of the mesh's surface only what the views should see is
 * matched.
 * \param[in] mesh of any size, not empty
 * \return nothing if there are too few points, or the mesh has no extent */
std::optional<MeshAlignment> alignMesh (const TriangleMesh& mesh, const AlignmentTarget& target, int threads);

/** \brief How well a mesh explains an object where it is; not at all if there are too few points. The mesh is in
 * the object's frame, and not empty. */
MeshAlignment judgeMesh (const TriangleMesh& mesh, const AlignmentTarget& target);

} // namespace pcl::cosection
