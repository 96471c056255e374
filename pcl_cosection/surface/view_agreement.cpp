// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "view_agreement.h"

#include <algorithm>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr std::size_t most_samples = 2000;

} // namespace

ViewAgreement::ViewAgreement (const std::vector<OrientedPoint>& points)
{
  const std::size_t stride = (points.size () + most_samples - 1) / most_samples;
  for (std::size_t p = 0; p < points.size (); p += stride)
    positions_.push_back (points[p].position);
  votes_.resize (positions_.size ());
}

void
ViewAgreement::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads)
{
  addVotes (positions_, view, T_points_sensor, votes_, 0.0, threads);
}

double
ViewAgreement::contradictedShare () const
{
  const auto contradicted = std::count_if (votes_.begin (), votes_.end (), [] (const FreeSpaceVotes& votes) {
    return votes.free > 0 && votes.free >= votes.surface;
  });
  return votes_.empty () ? 0.0 : static_cast<double> (contradicted) / static_cast<double> (votes_.size ());
}

} // namespace cosection
} // namespace pcl
