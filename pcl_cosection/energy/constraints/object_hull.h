// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "free_space_carving.h"
#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The hull of one object: all space that may belong to it. No view saw it free, it is above the support planes,
 * and it is connected with the object's points.
 *
 * Points only select the component of unseen space, so the hull shrinks as views are added, up to the margin around
 * surfaces within which space is not seen free. On a table a layer of that thickness remains unseen; the hull does not
 * extend along it away from the object.
 *
 * Use: add () every view; then finish (); then mesh () or meshWith (). Everything is in the object's frame. */
class ObjectHull
{
public:
  ObjectHull (const VoxelGrid& grid, const CoSectionOptions& options);

  void add (const FreeSpaceView& view, const Eigen::Isometry3d& T_object_sensor);

  /** \param[in] planes unit normals to the object's side
   * \param[in] layer_m thickness of the layer on planes along which the hull does not extend */
  void finish (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector4d>& planes, double layer_m);

  /** \brief The hull as a closed mesh with provenance and confidence. */
  TriangleMesh mesh () const { return meshOf (hull_); }

  /** \brief The union of the hull and a body as a closed mesh with provenance and confidence. */
  TriangleMesh meshWith (const SignedDistanceField& body) const;

private:
  /** \brief Signed distance to the space that was seen free, positive in it, clamped; voxels. */
  std::vector<float> distanceToFree () const;
  TriangleMesh meshOf (const SignedDistanceField& field) const;
  void attachEvidence (TriangleMesh& mesh) const;

  VoxelGrid grid_;
  CoSectionOptions options_;
  HullConstraint votes_;
  std::optional<FreeSpaceCarving> carving_;
  SignedDistanceField hull_;
  std::vector<std::uint8_t> free_space_;
  std::vector<float> data_distance_vox_;
  std::vector<Eigen::Vector4d> planes_;
};

} // namespace pcl::cosection
