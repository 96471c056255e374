// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/free_space_votes.h>
#include <pcl/cosection/surface/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief How well depth views agree with the points of a body, some of which are asked about: where poses are wrong or
 * something has moved, views look through points that others have measured. */
class ViewAgreement
{
public:
  explicit ViewAgreement (const std::vector<OrientedPoint>& points);

  void
  add (const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads);

  /** \brief Of the points: those that as many views look through as see a surface there, but at least one. */
  double
  contradictedShare () const;

private:
  std::vector<Eigen::Vector3f> positions_;
  std::vector<FreeSpaceVotes> votes_;
};

} // namespace cosection
} // namespace pcl
