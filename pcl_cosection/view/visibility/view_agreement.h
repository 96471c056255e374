// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "free_space_votes.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief How well depth views agree with the points of a body, some of which are asked about: a view whose pose is
 * wrong looks through points that others have measured, and so does one of a thing that has moved. */
class ViewAgreement
{
public:
  explicit ViewAgreement (const std::vector<OrientedPoint>& points);

  /** \param[in] number of the view */
  void add (int number, const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads);

  struct Contradiction
  {
    double share = 0.0; ///< of the points that a view sees, or would see if it did not look through them: the latter
    int view = 0;       ///< its number
  };

  /** \brief The largest; but of many views every twentieth may be worse. */
  Contradiction worst () const;

private:
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Contradiction> of_views_;
};

} // namespace pcl::cosection
