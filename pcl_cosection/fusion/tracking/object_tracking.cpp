// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "object_tracking.h"

namespace pcl::cosection
{

namespace
{

constexpr double least_in_view = 0.3; // of an object's surface: with less of it to be seen, it is hidden, not lost

} // namespace

void
trackObjects (const PosedFrame& frame, const std::vector<AssociatedModel>& expected,
              const std::vector<TrackedObject*>& objects, PoseTracking& tracking, EventLog& log)
{
  const Eigen::Isometry3d& T_world_camera = frame.T_world_camera;
  for (std::size_t m = 1; m < expected.size (); ++m)
  {
    TrackedObject& object = *objects[m - 1];
    PoseEstimate estimate = tracking.trackObject (frame.cloud, expected, m, 1.0 + object.frames_not_tracked,
                                                  object.brightness);
    if (!estimate.doubt.empty ())
    {
      // It may have stopped.
      std::vector<AssociatedModel> at_rest = expected;
      at_rest[m].T_model_sensor = object.T_world_object.inverse () * T_world_camera;
      const PoseEstimate other = tracking.trackObject (frame.cloud, at_rest, m, 1.0 + object.frames_not_tracked,
                                                       object.brightness);
      if (other.doubt.empty () || other.visibility.confirmedShare () > estimate.visibility.confirmedShare ())
        estimate = other;
    }
    if (estimate.doubt.empty ())
    {
      const Eigen::Isometry3d T_world_object = T_world_camera * estimate.T_model_camera.inverse ();
      const bool steady = object.state == ObjectState::Tracked && estimate.observed_directions == all_directions;
      if (object.state != ObjectState::Tracked)
        log.add (frame.stamp, "object ", object.id,
                 object.state == ObjectState::Lost ? " is found again" : " is in sight again");
      // What its surface does not tell must not go on by itself.
      object.last_motion = Eigen::Isometry3d::Identity ();
      if (steady)
        object.last_motion = T_world_object * object.T_world_object.inverse ();
      else if (object.state == ObjectState::Tracked)
        object.last_motion.translation () = T_world_object.translation () - object.T_world_object.translation ();
      object.moveTo (T_world_object);
      tracking.keep (frame.cloud, estimate.T_model_camera, object.brightness);
      object.state = ObjectState::Tracked;
      object.frames_not_tracked = 0;
      continue;
    }
    const bool hidden = estimate.visibility.inViewShare () < least_in_view;
    if (!hidden && object.state != ObjectState::Lost)
      log.add (frame.stamp, "object ", object.id, " is lost: ", estimate.doubt);
    else if (hidden && object.state == ObjectState::Tracked)
      log.add (frame.stamp, "object ", object.id, " is out of sight");
    object.state = hidden ? ObjectState::Hidden : ObjectState::Lost;
    ++object.frames_not_tracked;
  }
}

} // namespace pcl::cosection
