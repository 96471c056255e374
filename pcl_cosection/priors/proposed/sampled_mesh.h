// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/mesh_distance/triangle_tree.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief A mesh about its middle, in units of its spread, with points all over its surface. */
class SampledMesh
{
public:
  static constexpr Eigen::Index matched = 1500; ///< samples that are compared with points

  /** \param[in] mesh not empty, finite, no triangle without area */
  explicit SampledMesh (const TriangleMesh& mesh);

  /** \brief Whether it has an area. */
  bool hasExtent () const { return unit_ > 0.0; }

  /** \brief Middle of its surface, in its own frame. */
  const Eigen::Vector3d& middle () const { return middle_; }

  /** \brief Root mean square distance of its surface from the middle, in its own units. */
  double unit () const { return unit_; }

  /** \brief Place of a sample, below matched. */
  Eigen::Vector3d position (Eigen::Index n) const { return positions_.col (n); }

  /** \brief Unit normal of a sample. */
  Eigen::Vector3d normal (Eigen::Index n) const { return normals_.col (n); }

  /** \brief The nearest point of the surface, and its normal. */
  std::pair<Eigen::Vector3d, Eigen::Vector3d> nearest (const Eigen::Vector3d& p) const;

  /** \brief 1 for the samples that are seen from far away in about a direction. */
  const std::vector<std::uint8_t>& visibleFrom (const Eigen::Vector3d& direction) const;

private:
  void sample (const TriangleMesh& mesh);
  std::vector<std::uint8_t> findVisible (const Eigen::Vector3d& direction) const;

  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero ();
  double unit_ = 0.0;
  Eigen::Matrix3Xd positions_, normals_; // more than those that are matched: these fill the depth buffer
  std::vector<Eigen::Vector3d> directions_;
  std::vector<std::vector<std::uint8_t>> visible_; // by direction
  std::vector<Eigen::Vector3d> face_normals_;
  std::unique_ptr<const TriangleTree> tree_;
};

} // namespace pcl::cosection
