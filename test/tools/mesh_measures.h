// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief Exact distances of points to a mesh, by a binary tree of boxes. */
class ExactMeshDistance
{
public:
  explicit ExactMeshDistance (const TriangleMesh& mesh);

  /** \brief Infinite for an empty mesh. */
  double operator() (const Eigen::Vector3d& p) const;

private:
  struct Node
  {
    Eigen::AlignedBox3d box;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t right = 0; ///< the left child follows its parent; 0: a leaf
  };

  std::uint32_t build (std::uint32_t begin, std::uint32_t end);

  std::vector<std::array<Eigen::Vector3d, 3>> triangles_;
  std::vector<Node> nodes_;
};

/** \brief Random points of a mesh, uniform by area, the same for the same \a seed. */
std::vector<Eigen::Vector3d> sampleByArea (const TriangleMesh& mesh, std::size_t count, unsigned seed);

/** \brief The value that a share of \a fraction of \a values does not exceed. */
double percentile (std::vector<double> values, double fraction);

/** \brief Diagonal of the box of \a points without a share of \a trim at either end of each axis. */
double boxDiagonal (const std::vector<Eigen::Vector3d>& points, double trim);

/** \brief The plane n p + d = 0, (n, d) with |n| = 1 and d >= 0: the origin lies on the side that n points to. */
struct FittedPlane
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero ();
  double d = 0.0;
  std::size_t inliers = 0;
  double rms_m = 0.0; ///< of the inliers

  double height (const Eigen::Vector3d& p) const { return normal.dot (p) + d; }
};

/** \brief The plane with the most of \a points within \a tolerance_m (RANSAC), then least squares on these. */
std::optional<FittedPlane> fitDominantPlane (const std::vector<Eigen::Vector3d>& points, double tolerance_m,
                                             unsigned seed);

/** \brief The box of the voxel centres of a `.vti` file, from its header. */
struct VolumeBox
{
  Eigen::AlignedBox3d centres;
  double voxel_size_m = 0.0;
};

std::optional<VolumeBox> readVolumeBox (const std::string& vti_path);

} // namespace pcl::cosection::test
