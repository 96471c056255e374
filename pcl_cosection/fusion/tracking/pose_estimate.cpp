// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pose_estimate.h"

#include "pcl_cosection/fusion/run_log.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double standard_pixels = 640.0 * 480.0;
constexpr double correlated_pixels = 49.0; // the depth filter's window, in an image of so many

} // namespace

std::string
rejectionReason (const SdfAlignmentResult& result, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& guess,
                 const Eigen::Vector3d& centre, std::size_t points, const PoseLimits& limits, double frames_passed)
{
  if (result.stop == SdfAlignmentStop::TooFewPoints || result.stop == SdfAlignmentStop::NoGradient)
    return describe (result.stop);
  if (static_cast<double> (result.points_with_distance) < limits.min_points_share * static_cast<double> (points))
    return toText ("only ", result.points_with_distance, " of ", points, " points are where the model knows a surface");
  if (result.inlier_share < limits.min_inlier_share)
    return toText ("only ", 100.0 * result.inlier_share, " % of the points fit");
  const double shift = (pose * centre - guess * centre).norm ();
  const double turn = Eigen::AngleAxisd (guess.linear ().transpose () * pose.linear ()).angle ();
  if (shift > limits.max_shift_m * frames_passed || turn > limits.max_turn_rad * frames_passed)
    return toText ("the pose would jump by ", shift, " m and ", turn * 180.0 / M_PI, " degrees");
  return "";
}

double
correlatedReadings (const PinholeCamera& camera)
{
  return std::max (1.0, correlated_pixels * camera.width * camera.height / standard_pixels);
}

std::vector<float>
readingWeights (const std::vector<Eigen::Vector3f>& points, double voxel_size_m, std::vector<float> weights)
{
  for (std::size_t n = 0; n < points.size (); ++n)
    weights[n] *= readingWeight (points[n].z (), voxel_size_m);
  return weights;
}

} // namespace pcl::cosection
