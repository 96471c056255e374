// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "pose_tracking.h"

#include "observed_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr std::size_t min_object_points = 50;
constexpr int object_rounds = 2;            // of association and alignment
constexpr double min_confirmed = 0.5;       // of an object's surface that a frame confirms or contradicts
constexpr double min_found_confirmed = 0.7; // of one that comes back
constexpr double min_in_view = 0.1;
constexpr double min_tracked_in_view = 0.3; // less of an object at the image's border slides
constexpr double tolerance_voxels = 2.0;
constexpr double standard_pixels = 640.0 * 480.0;
constexpr double correlated_pixels = 49.0; // the depth filter's window, in an image of so many

constexpr SampleOptions object_samples{1000, 1.5};
constexpr MotionPrior object_motion{0.0, 10.0}; // rather a shift than a turn
constexpr PoseLimits object_limits{0.15, 0.5, 0.3, 0.0};

Eigen::Vector3d
centroid (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  double total = 0.0;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (weights[n] > 0.0f)
    {
      sum += weights[n] * points[n].cast<double> ();
      total += weights[n];
    }
  return total > 0.0 ? Eigen::Vector3d (sum / total) : sum;
}

template <typename... Parts>
std::string
line (const Parts&... parts)
{
  std::ostringstream text;
  text.precision (3);
  (text << ... << parts);
  return text.str ();
}

/** \brief The reliable points that lie in a volume. */
std::vector<Eigen::Vector3f>
pointsNear (const FrameCloud& cloud, const AssociatedModel& model)
{
  const VoxelGrid& grid = model.volume->grid ();
  const Eigen::Isometry3d T_camera_model = model.T_model_sensor.inverse ();
  Eigen::AlignedBox2d seen;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d p = T_camera_model * grid.center ((corner & 1) * (grid.dims.x () - 1),
                                                            ((corner >> 1) & 1) * (grid.dims.y () - 1),
                                                            (corner >> 2) * (grid.dims.z () - 1));
    if (p.z () <= 0.0)
      return cloud.sample (1);
    seen.extend (cloud.camera.project (p));
  }
  const auto clamped = [] (double value, int last) {
    return static_cast<int> (std::min<double> (last, std::max (0.0, value)));
  };
  std::vector<Eigen::Vector3f> points;
  if (seen.max ().x () < 0.0 || seen.max ().y () < 0.0 || seen.min ().x () > cloud.camera.width ||
      seen.min ().y () > cloud.camera.height)
    return points;
  for (int v = clamped (seen.min ().y (), cloud.camera.height - 1);
       v <= clamped (seen.max ().y (), cloud.camera.height - 1); ++v)
    for (int u = clamped (seen.min ().x (), cloud.camera.width - 1);
         u <= clamped (seen.max ().x (), cloud.camera.width - 1); ++u)
    {
      const Eigen::Vector3f& p = cloud.points[static_cast<std::size_t> (v) * cloud.camera.width + u];
      if (std::isfinite (cloud.reliable.at (u, v)) && grid.nearest (model.T_model_sensor * p.cast<double> ()))
        points.push_back (p);
    }
  return points;
}

} // namespace

std::string
rejectionReason (const SdfAlignmentResult& result, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& guess,
                 const Eigen::Vector3d& centre, std::size_t points, const PoseLimits& limits, double frames_passed)
{
  if (result.stop == SdfAlignmentStop::TooFewPoints || result.stop == SdfAlignmentStop::NoGradient)
    return describe (result.stop);
  if (static_cast<double> (result.points_with_distance) < limits.min_points_share * static_cast<double> (points))
    return line ("only ", result.points_with_distance, " of ", points, " points are where the model knows a surface");
  if (result.inlier_share < limits.min_inlier_share)
    return line ("only ", 100.0 * result.inlier_share, " % of the points fit");
  const double shift = (pose * centre - guess * centre).norm ();
  const double turn = Eigen::AngleAxisd (guess.linear ().transpose () * pose.linear ()).angle ();
  if (shift > limits.max_shift_m * frames_passed || turn > limits.max_turn_rad * frames_passed)
    return line ("it would have jumped by ", shift, " m and ", turn * 180.0 / M_PI, " degrees");
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

PoseEstimate
trackObject (const FrameCloud& cloud, std::vector<AssociatedModel> models, std::size_t target, double frames_passed,
             const BrightnessReference& brightness, const PoseSolver& solver)
{
  const TsdfVolume& volume = *models[target].volume;
  const Eigen::Isometry3d guess = models[target].T_model_sensor;
  PoseEstimate estimate;
  estimate.T_model_camera = guess;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero ();
  for (int round = 0; round < object_rounds; ++round)
  {
    estimate.tracked.points = pointsNear (cloud, models[target]);
    const std::vector<Eigen::Vector3f>& points = estimate.tracked.points;
    estimate.tracked.probabilities = solver.association.probabilities (points, models, target);
    if (round == 0)
      centre = centroid (points, estimate.tracked.probabilities);
    const std::vector<float> weights = readingWeights (points, volume.grid ().voxel_size_m,
                                                       estimate.tracked.probabilities);
    estimate.alignment = solver.alignment.align (points, weights, volume, models[target].T_model_sensor);
    const Eigen::Isometry3d& found = estimate.alignment.T_grid_sensor;
    const std::vector<SurfaceSample> samples = sampleSurface (points, weights, volume, found, object_samples);
    const ObservedMotion observed = observedMotion (samples, guess, found, object_motion);
    const UncertainPose by_shape{observed.T_model_camera, observed.precision / correlatedReadings (cloud.camera)};
    const BrightnessFit fit = trackBrightness (brightness, cloud, MotionChart (samples), by_shape, guess);
    const std::optional<UncertainPose>& by_brightness = fit.pose;
    estimate.tracked.brightness_agreement = fit.agreement;
    const int by_shape_alone = std::min (observed.directions, estimate.alignment.observed_directions);
    // Distances alone let a pose slide along directions that they do not observe.
    estimate.rejection_reason = estimate.alignment.points_with_distance < min_object_points
                                    ? std::string (describe (SdfAlignmentStop::TooFewPoints))
                                    : rejectionReason (estimate.alignment,
                                                       by_brightness ? by_brightness->T_model_camera : found, guess,
                                                       centre, points.size (), object_limits, frames_passed);
    if (!estimate.isAccepted ())
      break;
    estimate.T_model_camera = by_brightness ? by_brightness->T_model_camera : observed.T_model_camera;
    estimate.observed_directions = by_brightness ? std::max (by_shape_alone, by_brightness->directions ())
                                                 : by_shape_alone;
    models[target].T_model_sensor = estimate.T_model_camera;
  }
  estimate.visibility = checkVisibility (volume, estimate.T_model_camera, cloud,
                                         tolerance_voxels * volume.grid ().voxel_size_m);
  if (estimate.isAccepted () && estimate.visibility.inViewShare () < min_tracked_in_view)
    estimate.rejection_reason = line ("only ", 100.0 * estimate.visibility.inViewShare (),
                                      " % of its surface is in view");
  else if (estimate.isAccepted () && estimate.visibility.confirmedShare () < min_confirmed)
    estimate.rejection_reason = line ("readings are behind ", 100.0 * (1.0 - estimate.visibility.confirmedShare ()),
                                      " % of its surface");
  return estimate;
}

PoseEstimate
findObject (const FrameCloud& cloud, const std::vector<Eigen::Vector3f>& points, const TsdfVolume& volume,
            const Eigen::Isometry3d& guess, SdfAlignment& alignment)
{
  PoseEstimate estimate;
  const std::vector<float> weights = readingWeights (points, volume.grid ().voxel_size_m,
                                                     std::vector<float> (points.size (), 1.0f));
  estimate.alignment = alignment.align (points, weights, volume, guess);
  estimate.T_model_camera = estimate.alignment.T_grid_sensor;
  estimate.visibility = checkVisibility (volume, estimate.T_model_camera, cloud,
                                         tolerance_voxels * volume.grid ().voxel_size_m);
  const SdfAlignmentResult& result = estimate.alignment;
  if (result.points_with_distance < std::max (min_object_points, points.size () / 2))
    estimate.rejection_reason = "most points are where its model knows nothing";
  else if (result.inlier_share < min_found_confirmed)
    estimate.rejection_reason = line ("only ", 100.0 * result.inlier_share, " % of the points fit");
  else if (estimate.visibility.confirmedShare () < min_found_confirmed ||
           estimate.visibility.inViewShare () < min_in_view)
    estimate.rejection_reason = "the readings do not confirm its surface";
  return estimate;
}

} // namespace pcl::cosection
