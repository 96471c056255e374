// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "level_mirror.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <vector>

namespace pcl::cosection {
namespace {

// Samples that make a part: of the top, or below the mirror plane. Of scanned things that lie, and of standing books, a
// tenth and more are of the top; of open boxes of which walls are seen, less than a hundredth.
constexpr double least_share = 0.05;
constexpr double upwards = 0.7;       // component upwards of the normals of a top
constexpr double least_support = 0.1; // share of the copies: more than by chance
// Log-likelihood ratio per copy that supports or contradicts: the others are hidden, as most copies of what lies are.
// Of scanned things, those that stand (bottles, a drill, a pitcher) have at most 0.7; most that lie (pens, clamps, a
// hammer, soap) have 1.1 to 2.0.
constexpr double least_evidence = 1.0;

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
  const double middle_m = 0.5 * quantile (heights_m, 1.0 - least_share);
  const auto tops = std::count_if (of_tops_m.begin (), of_tops_m.end (), [&] (double m) { return m > middle_m; });
  // An open box shows walls and hardly any top. Its opening would be copied to its bottom.
  if (quantile (heights_m, least_share) > middle_m || static_cast<double> (tops) < least_share * count)
    return std::nullopt;
  const Eigen::Affine3d mirror = reflection (up, middle_m - plane[3]);
  const CopyEvidence evidence = judge.judge ({mirror});
  const double visible = evidence.support + evidence.contradiction;
  const bool is_confirmed = evidence.support > least_support &&
                            evidence.logLikelihoodRatio () > least_evidence * visible;
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
