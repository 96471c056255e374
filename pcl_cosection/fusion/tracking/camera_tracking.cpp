// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "camera_tracking.h"

#include "observed_motion.h"
#include "pcl_cosection/fusion/mapping/resting_objects.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection
{

namespace
{

constexpr std::size_t min_points = 200;
constexpr PoseLimits limits{0.15, 0.26, 0.3, 0.1};
constexpr SampleOptions background_samples{5000, 0.0, true};
constexpr int rounds = 2;           // without and with what is found to move
constexpr double new_movers = 0.01; // of the points' weight, from which on a second round is worth it

} // namespace

CameraTracking::CameraTracking (int max_points, const AssociationOptions& association, int threads)
    : alignment_ (trackingOptions (max_points, threads))
    , association_ (association)
    , max_points_ (max_points)
{}

void
CameraTracking::begin (const FrameCloud& cloud)
{
  at_rest_.begin (cloud);
}

PoseEstimate
CameraTracking::track (const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
                       const std::vector<TrackedObject*>& objects, const Eigen::Isometry3d& guess, double frames_passed)
{
  const double pixels = static_cast<double> (cloud.camera.width) * cloud.camera.height;
  const int step = std::max (1, static_cast<int> (std::ceil (std::sqrt (pixels / max_points_) - 0.01)));
  const double correlated = std::max (1.0, correlatedReadings (cloud.camera) / (step * step));
  const std::vector<Eigen::Vector3f> points = cloud.sample (step);
  const TsdfVolume& background = *models[0].volume;
  PoseEstimate estimate;
  estimate.T_model_camera = guess;
  if (points.size () < min_points)
  {
    estimate.doubt = "there are hardly any readings";
    return estimate;
  }
  std::vector<float> of_background = association_.probabilities (points, models, 0);
  points_ = points;
  const std::vector<float> probabilities = of_background;
  weighReadings (points, background.grid ().voxel_size_m, of_background);
  moving_.begin (cloud, guess);
  double left_out = 0.0;
  for (int round = 0; round < rounds; ++round)
  {
    std::vector<float> weights = of_background;
    const double share = moving_.weigh (cloud.camera, points, weights);
    of_background_ = probabilities;
    moving_.weigh (cloud.camera, points, of_background_);
    if (round > 0 && std::abs (share - left_out) < new_movers)
      break;
    left_out = share;
    estimate.alignment = alignment_.align (points, weights, background, guess);
    const Eigen::Isometry3d& found = estimate.alignment.T_grid_sensor;
    const std::vector<SurfaceSample> samples = sampleSurface (points, weights, background, found, background_samples);
    const ObservedMotion observed = observedMotion (samples, before_, found, {correlated});
    estimate.T_model_camera = observed.T_model_camera;
    estimate.observed_directions = std::min (observed.directions, estimate.alignment.observed_directions);
    // What the shape tells is believed here also where it is little: brightness says how much of it is noise.
    const UncertainPose by_shape{observedMotion (samples, before_, found, {}).T_model_camera,
                                 observed.precision / correlated};
    const auto by_brightness = brightness_.track (cloud, MotionChart (samples), by_shape, guess);
    if (by_brightness)
    {
      estimate.T_model_camera = by_brightness->T_model_camera;
      estimate.observed_directions = std::max (estimate.observed_directions, by_brightness->directions ());
    }
    if (!by_brightness || by_brightness->directions () < all_directions)
    {
      const HeldPose held = holdByRestingObjects ({points, weights, models, objects, guess}, association_,
                                                  estimate.T_model_camera);
      estimate.T_model_camera = held.T_world_camera;
      estimate.observed_directions = std::max (estimate.observed_directions, held.directions);
    }
    const bool at_rest = at_rest_.isPreferredTo (estimate.T_model_camera, cloud, moving_);
    if (at_rest)
      estimate.T_model_camera = at_rest_.T_world_camera ();
    moving_.look (cloud, models, association_, estimate.T_model_camera);
    if (at_rest)
      break;
  }
  estimate.doubt = doubtOf (estimate.alignment, estimate.alignment.T_grid_sensor, guess,
                            Eigen::Vector3d (0.0, 0.0, 1.0), points.size (), limits, frames_passed);
  return estimate;
}

void
CameraTracking::keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera)
{
  before_ = T_world_camera;
  brightness_.keep (cloud, points_, of_background_, T_world_camera);
  moving_.keep (cloud, T_world_camera);
  at_rest_.keep (cloud, T_world_camera);
}

} // namespace pcl::cosection
