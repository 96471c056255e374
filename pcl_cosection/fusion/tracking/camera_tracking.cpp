// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "camera_tracking.h"

#include "observed_motion.h"
#include "pcl_cosection/fusion/mapping/resting_objects.h"
#include "pose_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double min_readings_share = 500 / (640.0 * 480.0); // of the pixels
constexpr std::size_t min_points = 200;
constexpr PoseLimits limits{0.15, 0.26, 0.3, 0.1};
constexpr SampleOptions background_samples{5000, 0.0, true};
constexpr int rounds = 2;           // the second one without the parts that the first one found to move
constexpr double new_movers = 0.01; // of the points' weight, from which on a second round is worth it

/** \brief A pose of the camera and everything that was concluded with it. */
struct CameraEstimate
{
  PoseEstimate pose; ///< T_model_camera is T_world_camera
  MovingParts moving;
  RestDecision rest;
};

/** \brief The pose after alignment with the background's volume, by shape, brightness and objects at rest. */
void
refineByObservations (const FrameCloud& cloud, const std::vector<float>& weights, const SceneModels& scene,
                      const CameraState& before, const Eigen::Isometry3d& guess, double correlated,
                      const DataAssociation& association, PoseEstimate& pose)
{
  const std::vector<Eigen::Vector3f>& points = pose.tracked.points;
  const Eigen::Isometry3d& found = pose.alignment.T_grid_sensor;
  const std::vector<SurfaceSample> samples = sampleSurface (points, weights, *scene.models[0].volume, found,
                                                            background_samples);
  const ObservedMotion observed = observedMotion (samples, before.T_world_camera, found, {correlated});
  pose.T_model_camera = observed.T_model_camera;
  pose.observed_directions = std::min (observed.directions, pose.alignment.observed_directions);
  // Insignificant motion by the shape counts here: brightness decides how much of it is noise.
  const UncertainPose by_shape{observedMotion (samples, before.T_world_camera, found, {}).T_model_camera,
                               observed.precision / correlated};
  const BrightnessFit fit = trackBrightness (before.brightness, cloud, MotionChart (samples), by_shape, guess);
  pose.tracked.brightness_agreement = fit.agreement;
  if (fit.pose)
  {
    pose.T_model_camera = fit.pose->T_model_camera;
    pose.observed_directions = std::max (pose.observed_directions, fit.pose->directions ());
  }
  if (!fit.pose || fit.pose->directions () < all_directions)
  {
    const HeldPose held = holdByRestingObjects (points, weights, scene, guess, association, pose.T_model_camera);
    pose.T_model_camera = held.T_world_camera;
    pose.observed_directions = std::max (pose.observed_directions, held.directions);
  }
}

CameraEstimate
estimateCamera (const FrameCloud& cloud, const SceneModels& scene, const CameraState& before,
                const Eigen::Isometry3d& guess, double frames_passed, const FusionSetup& setup, SdfAlignment& alignment)
{
  const double pixels = static_cast<double> (cloud.camera.width) * cloud.camera.height;
  const int step = std::max (1,
                             static_cast<int> (std::ceil (std::sqrt (pixels / setup.options.tracking_points) - 0.01)));
  const double correlated = std::max (1.0, correlatedReadings (cloud.camera) / (step * step));
  const std::vector<Eigen::Vector3f> points = cloud.sample (step);
  const TsdfVolume& background = *scene.models[0].volume;
  CameraEstimate estimate;
  PoseEstimate& pose = estimate.pose;
  pose.T_model_camera = guess;
  if (points.size () < min_points)
  {
    pose.rejection_reason = "too few depth readings";
    return estimate;
  }
  pose.tracked.points = points;
  const std::vector<float> of_background = setup.association.probabilities (points, scene.models, 0);
  const std::vector<float> reading_weights = readingWeights (points, background.grid ().voxel_size_m, of_background);
  const MovingParts carried = carryOver (before.moving, cloud, guess);
  estimate.moving = carried;
  double left_out = 0.0;
  for (int round = 0; round < rounds; ++round)
  {
    const auto [weights, moving_share] = restingWeights (estimate.moving, cloud.camera, points, reading_weights);
    pose.tracked.probabilities = restingWeights (estimate.moving, cloud.camera, points, of_background).weights;
    if (round > 0 && std::abs (moving_share - left_out) < new_movers)
      break;
    left_out = moving_share;
    pose.alignment = alignment.align (points, weights, background, guess);
    refineByObservations (cloud, weights, scene, before, guess, correlated, setup.association, pose);
    estimate.rest = decideRest (before.rest, pose.T_model_camera, cloud, estimate.moving);
    if (estimate.rest.at_rest)
      pose.T_model_camera = before.rest.T_world_camera;
    estimate.moving = observeMotion (carried, cloud, scene.models, setup.association, pose.T_model_camera);
    if (estimate.rest.at_rest)
      break;
  }
  pose.rejection_reason = rejectionReason (pose.alignment, pose.alignment.T_grid_sensor, guess,
                                           Eigen::Vector3d (0.0, 0.0, 1.0), points.size (), limits, frames_passed);
  return estimate;
}

/** \brief The state after a frame whose pose is accepted. */
CameraState
accepted (CameraState state, CameraEstimate estimate, const FrameCloud& cloud, std::size_t frame)
{
  const Eigen::Isometry3d& T_world_camera = estimate.pose.T_model_camera;
  state.T_world_camera = T_world_camera;
  state.last_frame = frame;
  state.brightness = nextReference (std::move (state.brightness), cloud, estimate.pose.tracked, T_world_camera);
  state.rest = nextReference (std::move (state.rest), estimate.rest, cloud, T_world_camera);
  state.moving = std::move (estimate.moving);
  state.moving.T_world_camera = T_world_camera;
  return state;
}

/** \brief Whether hardly any reading is outside the instances of a mask. */
bool
hasReadingsOfObjectsOnly (const RgbdFrame& frame, const Image<std::uint16_t>& mask)
{
  std::size_t of_objects = 0, others = 0;
  for (std::size_t n = 0; n < frame.depth.pixels.size (); ++n)
    if (std::isfinite (frame.depth.pixels[n]))
      (mask.pixels[n] != 0 ? of_objects : others) += 1;
  return of_objects > 0 &&
         static_cast<double> (others) < min_readings_share * static_cast<double> (frame.depth.pixels.size ());
}

CameraState
lost (CameraState state)
{
  ++state.frames_lost;
  state.last_motion = Eigen::Isometry3d::Identity ();
  return state;
}

} // namespace

CameraStep
trackCamera (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>* mask,
             const std::optional<TsdfVolume>& background, const ObjectMap& objects, CameraState before,
             const FusionSetup& setup, SdfAlignment& alignment, EventLog& log)
{
  if (static_cast<double> (cloud.readings) < min_readings_share * static_cast<double> (cloud.points.size ()))
  {
    log.add (frame.stamp, "too few depth readings: ", cloud.readings);
    return {lost (std::move (before)), false, 0.0};
  }
  CameraEstimate estimate;
  estimate.pose.T_model_camera = before.T_world_camera;
  const bool only_objects = mask != nullptr && hasReadingsOfObjectsOnly (frame, *mask);
  if (only_objects && !before.only_objects)
    log.add (frame.stamp, "only objects have readings: the camera is taken to be at rest");
  before.only_objects = only_objects;
  if (!background || only_objects)
    return {accepted (std::move (before), std::move (estimate), cloud, frame.index), true, 1.0};
  const double frames_passed = std::max (1.0,
                                         static_cast<double> (frame.index) - static_cast<double> (before.last_frame));
  for (const Eigen::Isometry3d& motion : {before.last_motion, Eigen::Isometry3d (Eigen::Isometry3d::Identity ())})
  {
    const Eigen::Isometry3d guess = before.T_world_camera * motion;
    estimate = estimateCamera (cloud, expectedModels (*background, objects, guess), before, guess, frames_passed, setup,
                               alignment);
    if (estimate.pose.isAccepted () || before.last_motion.isApprox (Eigen::Isometry3d::Identity (), 1e-9))
      break;
  }
  const double inlier_share = estimate.pose.alignment.inlier_share;
  if (!estimate.pose.isAccepted ())
  {
    if (before.frames_lost == 0)
      log.add (frame.stamp, "the camera is lost: ", estimate.pose.rejection_reason);
    return {lost (std::move (before)), false, inlier_share};
  }
  if (before.frames_lost > 0)
    log.add (frame.stamp, "the camera is found again after ", before.frames_lost, " frames");
  // Motion along directions that are not observed must not go on by itself.
  const bool steady = frames_passed == 1.0 && estimate.pose.observed_directions == all_directions;
  before.last_motion = steady ? Eigen::Isometry3d (before.T_world_camera.inverse () * estimate.pose.T_model_camera)
                              : Eigen::Isometry3d::Identity ();
  before.frames_lost = 0;
  return {accepted (std::move (before), std::move (estimate), cloud, frame.index), true, inlier_share};
}

} // namespace pcl::cosection
