// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "view_agreement.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_samples = 2000;
constexpr double bad_views = 0.05;  // of all views, may contradict
constexpr double least_asked = 0.1; // of the points, about which a view must say something

} // namespace

ViewAgreement::ViewAgreement (const std::vector<OrientedPoint>& points)
{
  const std::size_t stride = (points.size () + most_samples - 1) / most_samples;
  for (std::size_t p = 0; p < points.size (); p += stride)
    positions_.push_back (points[p].position);
}

void
ViewAgreement::add (int number, const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads)
{
  std::vector<FreeSpaceVotes> votes (positions_.size ());
  addVotes (positions_, view, T_points_sensor, votes, 0.0, threads);
  int free = 0, surface = 0;
  for (const FreeSpaceVotes& vote : votes)
  {
    free += vote.free;
    surface += vote.surface;
  }
  if (free + surface < least_asked * static_cast<double> (positions_.size ()))
    return;
  of_views_.push_back ({static_cast<double> (free) / (free + surface), number});
}

ViewAgreement::Contradiction
ViewAgreement::worst () const
{
  if (of_views_.empty ())
    return {};
  std::vector<Contradiction> sorted = of_views_;
  std::sort (sorted.begin (), sorted.end (), [] (const Contradiction& a, const Contradiction& b) {
    return a.share > b.share || (a.share == b.share && a.view < b.view);
  });
  return sorted[static_cast<std::size_t> (bad_views * static_cast<double> (sorted.size ()))];
}

} // namespace pcl::cosection
