// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "only_side.h"

#include "extent_prior.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/priors/symmetry/copy_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_points = 1000; // of an object
constexpr double outlier_share = 0.05;    // of points, at either end of the normal ...
constexpr double end_share = 0.01;        // ... and of directions along the plane, as observedExtents () has it
constexpr int angles = 36;                // of these directions
// The points of a flat side fill less than this share of a depth along the side's normal. Where a simulated lidar saw
// more than one side of a thing, they fill at least 0.26 of its mesh's extent (86 things), else at most 0.13 (ten); a
// book on its edge is the only one among 190 scanned and real things on tables that fills less than 0.15.
constexpr double flat_share = 0.15;
// Share of the side's points that are in seen free space at its other end. Boxes that simulated lidars saw (27) and
// scanned things (11 views) have at most 0.072 if they are that deep or hardly less, at least 0.15 if they are not.
constexpr double most_contradiction = 0.07;
// Share of the depth that the extent prior allows. Thinner things show enough of another side for symmetries to find
// their depth: with 0.25 a scanned book of 37 mm has a completeness of 3.7 mm instead of 2.4 mm.
constexpr double least_depth = 0.5;
constexpr int bisections = 6;
constexpr double most_upwards = 0.7; // component upwards of a steep side's normal

} // namespace

bool
SeenSide::isFlat (double depth_m) const
{
  return high_m - low_m < flat_share * depth_m;
}

SeenSide
seenSide (const std::vector<OrientedPoint>& points)
{
  SeenSide side;
  std::vector<OrientedPoint> some;
  Eigen::Vector3d facing = Eigen::Vector3d::Zero ();
  for (std::size_t p = 0; p < points.size (); p += points.size () / most_points + 1)
  {
    some.push_back (points[p]);
    facing += points[p].normal.cast<double> ();
  }
  if (some.empty () || facing.isZero ())
    return side;
  std::vector<Eigen::Vector3d> positions;
  for (const NormalLine& line : normalLinesOf (some).lines)
    positions.push_back (line.position);
  side.normal = planeNormal (positions, facing.normalized ());
  std::vector<double> along_m (some.size ());
  const auto project = [&] (const Eigen::Vector3d& direction) {
    std::transform (some.begin (), some.end (), along_m.begin (),
                    [&] (const OrientedPoint& point) { return direction.dot (point.position.cast<double> ()); });
  };
  project (side.normal);
  side.low_m = trimmedMin (along_m, outlier_share);
  side.high_m = trimmedMax (along_m, outlier_share);
  const Eigen::Vector3d u = side.normal.unitOrthogonal (), v = side.normal.cross (u);
  side.width_m = std::numeric_limits<double>::infinity ();
  for (int k = 0; k < angles; ++k)
  {
    const double angle = M_PI * k / angles;
    project (std::cos (angle) * u + std::sin (angle) * v);
    side.width_m = std::min (side.width_m, trimmedMax (along_m, end_share) - trimmedMin (along_m, end_share));
  }
  return side;
}

std::optional<Eigen::Vector4d>
planeBehindOnlySide (const Observation& object, const Eigen::Vector4d& plane, const MeasuredShape& shape)
{
  const SeenSide side = seenSide (object.points ());
  const double depth_m = ExtentPrior ().depth_factor * side.width_m;
  if (side.normal.isZero () || !side.isFlat (depth_m) || side.normal.dot (plane.head<3> ()) > most_upwards)
    return std::nullopt;
  const CopyJudge judge (shape, object.points (), plane, object.views);
  const auto mayReach = [&] (double behind_m) {
    const Eigen::Affine3d to_end (Eigen::Translation3d (-behind_m * side.normal));
    return judge.judge ({to_end}).contradiction < most_contradiction;
  };
  double reached_m = least_depth * depth_m, other_m = depth_m;
  if (!mayReach (reached_m))
    return std::nullopt;
  if (mayReach (depth_m))
    reached_m = depth_m;
  else
    for (int round = 0; round < bisections; ++round)
      (mayReach (0.5 * (reached_m + other_m)) ? reached_m : other_m) = 0.5 * (reached_m + other_m);
  Eigen::Vector4d behind;
  behind << side.normal, reached_m - side.low_m;
  return behind;
}

} // namespace pcl::cosection
