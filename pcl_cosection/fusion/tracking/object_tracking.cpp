// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_tracking.h"

#include "observed_motion.h"
#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/tracking/surface_points.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t min_object_points = 50;
constexpr int object_rounds = 2;            // of association and alignment
constexpr double min_confirmed = 0.5;       // of an object's surface that a frame confirms or contradicts
constexpr double min_found_confirmed = 0.7; // of one that comes back
constexpr double min_in_view = 0.1;
constexpr double min_tracked_in_view = 0.3; // less of an object at the image's border slides
constexpr double tolerance_voxels = 2.0;

constexpr SampleOptions object_samples{1000, 1.5};
constexpr MotionPrior object_motion{0.0, 10.0}; // rather a shift than a turn
constexpr PoseLimits object_limits{0.15, 0.5, 0.3, 0.0};
constexpr double least_in_view = 0.3; // of an object's surface: an object with less of it in view is hidden, not lost

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

/** \brief The reliable points that lie in a volume. */
std::vector<Eigen::Vector3f>
pointsNear (const FrameCloud& cloud, const AssociatedModel& model)
{
  const VoxelGrid& grid = model.volume->grid ();
  const Eigen::Isometry3d T_camera_model = model.T_model_sensor.inverse ();
  Eigen::AlignedBox2d seen;
  for (const Eigen::Vector3d& corner : corners (grid))
  {
    const Eigen::Vector3d p = T_camera_model * corner;
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

/** \brief Compare a model's surface points with the readings of their pixels. \param[in] tolerance_m how far a reading
 * may be from the surface, beside three standard deviations of its noise */
Visibility
checkVisibility (const TsdfVolume& volume, const Eigen::Isometry3d& T_model_camera, const FrameCloud& cloud,
                 double tolerance_m)
{
  Visibility result;
  const Eigen::Isometry3d T_camera_model = T_model_camera.inverse ();
  const Eigen::Vector3f eye = T_model_camera.translation ().cast<float> ();
  for (const Eigen::Vector3f& point : surfacePoints (volume.field ()))
  {
    const auto cell = volume.sample<float> (point);
    if (!cell || cell->gradient ().dot (eye - point) <= 0.0f)
      continue; // it is turned away, or at the end of the known space
    const Eigen::Vector3d p = T_camera_model * point.cast<double> ();
    ++result.facing;
    const std::optional<Eigen::Array2i> pixel = pixelOf (cloud.camera, p);
    if (!pixel)
      continue;
    const PointVisibility seen = compareWithReading (p.z (), cloud.depth.at (pixel->x (), pixel->y ()),
                                                     tolerance_m + 3.0 * depthNoiseSigma (p.z ()));
    result.confirmed += seen == PointVisibility::AtSurface;
    result.contradicted += seen == PointVisibility::Free;
  }
  return result;
}

/** \brief Track an object from its pose among the models: points weighted by association are aligned with its volume,
 * and brightness determines what the shape leaves open. \param[in] target number of its model */
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
    estimate.rejection_reason = toText ("only ", 100.0 * estimate.visibility.inViewShare (),
                                        " % of its surface is in view");
  else if (estimate.isAccepted () && estimate.visibility.confirmedShare () < min_confirmed)
    estimate.rejection_reason = toText ("readings are behind ", 100.0 * (1.0 - estimate.visibility.confirmedShare ()),
                                        " % of its surface");
  return estimate;
}

/** \brief Track an object from where it is expected; if that fails, from where it was: it may have stopped. */
PoseEstimate
estimateObject (const PosedFrame& frame, const std::vector<AssociatedModel>& expected, std::size_t model,
                const TrackedObject& object, const PoseSolver& solver)
{
  const double frames_passed = 1.0 + object.frames_not_tracked;
  PoseEstimate moved = trackObject (frame.cloud, expected, model, frames_passed, object.brightness, solver);
  if (moved.isAccepted ())
    return moved;
  std::vector<AssociatedModel> at_rest = expected;
  at_rest[model].T_model_sensor = object.T_world_object.inverse () * frame.T_world_camera;
  PoseEstimate stopped = trackObject (frame.cloud, at_rest, model, frames_passed, object.brightness, solver);
  const bool better = stopped.isAccepted () ||
                      stopped.visibility.confirmedShare () > moved.visibility.confirmedShare ();
  return better ? stopped : moved;
}

/** \brief Take over a pose that is accepted. */
void
accept (const PosedFrame& frame, const PoseEstimate& estimate, TrackedObject& object)
{
  const Eigen::Isometry3d T_world_object = frame.T_world_camera * estimate.T_model_camera.inverse ();
  // Motion along directions that are not observed must not go on by itself.
  object.last_motion = Eigen::Isometry3d::Identity ();
  if (object.isTracked () && estimate.observed_directions == all_directions)
    object.last_motion = T_world_object * object.T_world_object.inverse ();
  else if (object.isTracked ())
    object.last_motion.translation () = T_world_object.translation () - object.T_world_object.translation ();
  object.moveTo (T_world_object);
  object.brightness = nextReference (std::move (object.brightness), frame.cloud, estimate.tracked,
                                     estimate.T_model_camera);
  object.state = ObjectState::Tracked;
  object.frames_not_tracked = 0;
}

} // namespace

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
    estimate.rejection_reason = "most points are outside the known part of its model";
  else if (result.inlier_share < min_found_confirmed)
    estimate.rejection_reason = toText ("only ", 100.0 * result.inlier_share, " % of the points fit");
  else if (estimate.visibility.confirmedShare () < min_found_confirmed ||
           estimate.visibility.inViewShare () < min_in_view)
    estimate.rejection_reason = "the readings do not confirm its surface";
  return estimate;
}

void
trackObjects (const PosedFrame& frame, const TsdfVolume& background, const PoseSolver& solver, ObjectMap& objects,
              EventLog& log)
{
  const SceneModels expected = expectedModels (background, objects, frame.T_world_camera);
  for (std::size_t m = 1; m < expected.models.size (); ++m)
  {
    TrackedObject& object = objects.by_id.at (expected.label (m));
    const PoseEstimate estimate = estimateObject (frame, expected.models, m, object, solver);
    if (estimate.isAccepted ())
    {
      if (!object.isTracked ())
        log.add (frame.stamp, "object ", object.id,
                 object.state == ObjectState::Lost ? " is found again" : " is in sight again");
      accept (frame, estimate, object);
      continue;
    }
    const bool hidden = estimate.visibility.inViewShare () < least_in_view;
    if (!hidden && object.state != ObjectState::Lost)
      log.add (frame.stamp, "object ", object.id, " is lost: ", estimate.rejection_reason);
    else if (hidden && object.isTracked ())
      log.add (frame.stamp, "object ", object.id, " is out of sight");
    object.state = hidden ? ObjectState::Hidden : ObjectState::Lost;
    ++object.frames_not_tracked;
  }
}

} // namespace pcl::cosection
