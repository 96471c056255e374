// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "level_mirror.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double top_share = 0.95; // quantile of the heights: a top may be wide, and its readings are noisy
constexpr double upwards = 0.7;    // component upwards of the normals of a top
constexpr double least_top = 0.05; // share of the samples that are of a top
// What is hidden neither confirms nor contradicts, and of what lies most is hidden. So copies that tell something are
// compared with each other, and not with all.
constexpr double least_support = 0.1;   // share of all copies: more than by chance
constexpr double support_against = 4.0; // contradictions, at least
constexpr double least_below = 0.05;    // share of the samples that are lower than the mirror plane

} // namespace

std::optional<Eigen::Affine3d>
findLevelMirror (const CopyJudge& judge, const Eigen::Vector4d& plane)
{
  if (!judge.hasEnoughSamples ())
    return std::nullopt;
  const Eigen::Vector3d up = plane.head<3> ();
  std::vector<double> heights_m, of_tops_m;
  for (const OrientedPoint& sample : judge.samples ())
  {
    heights_m.push_back (up.dot (sample.position.cast<double> ()) + plane[3]);
    if (up.dot (sample.normal.cast<double> ()) > upwards)
      of_tops_m.push_back (heights_m.back ());
  }
  const auto count = static_cast<double> (heights_m.size ());
  const double middle_m = 0.5 * quantile (heights_m, top_share);
  const auto tops = std::count_if (of_tops_m.begin (), of_tops_m.end (), [&] (double m) { return m > middle_m; });
  // Of walls without a top, as those of an open box, the copies of the opening would be an opening below.
  if (quantile (heights_m, least_below) > middle_m || static_cast<double> (tops) < least_top * count)
    return std::nullopt;
  const Eigen::Affine3d mirror = reflection (up, middle_m - plane[3]);
  const CopyEvidence evidence = judge.judge ({mirror});
  const bool is_confirmed = evidence.support > least_support &&
                            evidence.support > support_against * evidence.contradiction;
  return is_confirmed ? std::optional<Eigen::Affine3d> (mirror) : std::nullopt;
}

Motions
unitedWith (const Eigen::Affine3d& mirror, Motions motions)
{
  const std::size_t count = motions.size ();
  for (std::size_t m = 0; m < count; ++m)
    motions.push_back (mirror * motions[m]);
  motions.push_back (mirror);
  return motions;
}

} // namespace pcl::cosection
