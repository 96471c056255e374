// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sampled_mesh.h"

#include "pcl_cosection/common/directions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr Eigen::Index samples = 20000;
constexpr int view_directions = 162;
constexpr int buffer_side = 48;        // cells across the mesh: each gets some samples of a surface that faces it
constexpr double buffer_reach = 3.0;   // of the spread; what is beyond counts to the cells at the border
constexpr double hidden_behind = 0.15; // of the spread: what is so far behind the nearest sample of its cell is hidden
constexpr double least_facing = 0.1;   // cosine: surfaces seen at a lower angle give no readings

} // namespace

SampledMesh::SampledMesh (const TriangleMesh& mesh) : positions_ (3, samples), normals_ (3, matched)
{
  const std::vector<Eigen::Vector3d> points = sampleSurface (mesh, samples);
  for (Eigen::Index n = 0; n < samples; ++n)
    positions_.col (n) = points[static_cast<std::size_t> (n)];
  middle_ = positions_.rowwise ().mean ();
  positions_.colwise () -= middle_;
  unit_ = std::sqrt (positions_.colwise ().squaredNorm ().mean ());
  positions_ /= unit_;
  TriangleMesh normalised;
  normalised.triangles = mesh.triangles;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    normalised.vertices.emplace_back (((vertex.cast<double> () - middle_) / unit_).cast<float> ());
  surface_.emplace (normalised);
  for (Eigen::Index n = 0; n < matched; ++n)
    normals_.col (n) = surface_->nearest (positions_.col (n)).normal;
  for (int n = 0; n < view_directions; ++n)
  {
    directions_.push_back (sphereDirection (n, view_directions).cast<double> ());
    visible_.push_back (findVisible (directions_.back ()));
  }
}

std::vector<std::uint8_t>
SampledMesh::findVisible (const Eigen::Vector3d& direction) const
{
  const Eigen::Vector3d x = direction.unitOrthogonal (), y = direction.cross (x);
  const auto cellOf = [&] (const Eigen::Vector3d& p) {
    const auto cell = [] (double along) {
      return std::clamp (static_cast<int> ((along / buffer_reach * 0.5 + 0.5) * buffer_side), 0, buffer_side - 1);
    };
    return static_cast<std::size_t> (cell (y.dot (p))) * buffer_side + static_cast<std::size_t> (cell (x.dot (p)));
  };
  std::vector<double> nearest (static_cast<std::size_t> (buffer_side) * buffer_side,
                               -std::numeric_limits<double>::infinity ());
  for (Eigen::Index n = 0; n < samples; ++n)
  {
    double& so_far = nearest[cellOf (positions_.col (n))];
    so_far = std::max (so_far, direction.dot (positions_.col (n)));
  }
  std::vector<std::uint8_t> visible (static_cast<std::size_t> (matched), 0);
  for (Eigen::Index n = 0; n < matched; ++n)
    visible[static_cast<std::size_t> (n)] = normals_.col (n).dot (direction) > least_facing &&
                                            direction.dot (positions_.col (n)) >
                                                nearest[cellOf (positions_.col (n))] - hidden_behind;
  return visible;
}

const std::vector<std::uint8_t>&
SampledMesh::visibleFrom (const Eigen::Vector3d& direction) const
{
  const auto nearest = std::max_element (
      directions_.begin (), directions_.end (),
      [&] (const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.dot (direction) < b.dot (direction); });
  return visible_[static_cast<std::size_t> (nearest - directions_.begin ())];
}

} // namespace pcl::cosection
