// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A mesh about its middle, in units of its spread, with points all over its surface. */
class SampledMesh
{
public:
  static constexpr Eigen::Index matched = 1500; ///< samples that are compared with points

  /** \param[in] mesh as requireSurface () wants it */
  explicit SampledMesh (const TriangleMesh& mesh);

  /** \brief Middle of its surface, in its own frame. */
  const Eigen::Vector3d& middle () const { return middle_; }

  /** \brief Root mean square distance of its surface from the middle, in its own units. */
  double unit () const { return unit_; }

  /** \brief Place of a sample, below matched. */
  Eigen::Vector3d position (Eigen::Index n) const { return positions_.col (n); }

  /** \brief Unit normal of a sample. */
  Eigen::Vector3d normal (Eigen::Index n) const { return normals_.col (n); }

  /** \brief The nearest point of the surface, and its normal. */
  SurfaceDistance::Nearest nearest (const Eigen::Vector3d& p) const { return surface_->nearest (p); }

  /** \brief 1 for the samples that are seen from far away in about a direction. */
  const std::vector<std::uint8_t>& visibleFrom (const Eigen::Vector3d& direction) const;

private:
  std::vector<std::uint8_t> findVisible (const Eigen::Vector3d& direction) const;

  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero ();
  double unit_ = 1.0;
  Eigen::Matrix3Xd positions_; // more than those that are matched: these fill the depth buffer
  Eigen::Matrix3Xd normals_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<std::vector<std::uint8_t>> visible_; // by direction
  std::optional<SurfaceDistance> surface_;         // normalised
};

} // namespace pcl::cosection
