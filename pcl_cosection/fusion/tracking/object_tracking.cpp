// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "object_tracking.h"

#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr double least_in_view = 0.3; // of an object's surface: an object with less of it in view is hidden, not lost

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
