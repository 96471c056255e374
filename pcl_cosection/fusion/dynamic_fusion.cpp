// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include "dynamic_fusion_options.h"
#include "event_log.h"
#include "pcl_cosection/fusion/association/frame_segmentation.h"
#include "pcl_cosection/fusion/mapping/object_map.h"
#include "pcl_cosection/fusion/segmenters/scheduled_segmenter.h"
#include "pcl_cosection/fusion/tracking/camera_tracking.h"
#include "pcl_cosection/fusion/tracking/frame_cloud.h"
#include "pcl_cosection/fusion/tracking/object_tracking.h"
#include "pcl_cosection/fusion/tracking/pose_tracking.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr std::size_t min_readings = 500; // of an image of 640 x 480
constexpr double min_readings_share = min_readings / (640.0 * 480.0);
constexpr int mask_border_px = 2;        // beside an object, readings are mixed with its own
constexpr double uncounted_object = 0.5; // foreground probability of what no mask showed yet

} // namespace

struct DynamicFusion::Impl
{
  Impl (const PinholeCamera& camera, const DynamicFusionOptions& options);

  void process (const RgbdFrame& frame, const Image<std::uint16_t>* mask);
  bool trackCamera (const FrameCloud& cloud, const RgbdFrame& frame);
  FrameSegmentation segment (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>* mask);
  /** \brief What the segmenter finds, beside what is known; no mask: it is not its turn, or it cannot tell. */
  FrameInstances findInstances (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>& labels);
  void integrate (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>& labels);
  void report (const FrameSegmentation& segmentation);

  /** \brief The background, and the objects of a state or of any; relative to a camera at \a T_world_camera.
   * \param[in] predicted where objects should be in this frame, not where they were */
  std::vector<AssociatedModel> models (const Eigen::Isometry3d& T_world_camera, bool predicted,
                                       std::vector<TrackedObject*>& objects) const;

  template <typename Function> void timed (const char* stage, Function&& f)
  {
    const auto start = std::chrono::steady_clock::now ();
    f ();
    timings[stage] += std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
  }

  PinholeCamera camera;
  DynamicFusionOptions options;
  BackgroundModel background;
  ObjectMap objects;
  CameraTracking camera_tracking;
  PoseTracking tracking;
  DataAssociation association;
  ScheduledSegmenter segmenter;
  EventLog log;
  TrackedFrame result;
  std::map<std::string, double> timings;

  Eigen::Isometry3d T_world_camera;                               // the last good one
  Eigen::Isometry3d last_motion = Eigen::Isometry3d::Identity (); // of the camera, its own frame
  std::size_t last_frame = 0;                                     // of that pose
  int frames_lost = 0;                                            // of the camera, in a row
};

DynamicFusion::Impl::Impl (const PinholeCamera& camera, const DynamicFusionOptions& options)
    : camera (camera)
    , options (options)
    , background (backgroundOptions (options))
    , objects (camera, options)
    , camera_tracking (options.tracking_points, associationOptions (options), options.threads)
    , tracking (options.tracking_points, associationOptions (options), options.threads)
    , association (associationOptions (options))
    , segmenter (options.segment_every)
    , T_world_camera (options.first_pose)
{
  camera.validate ();
  options.validate ();
}

std::vector<AssociatedModel>
DynamicFusion::Impl::models (const Eigen::Isometry3d& T_world_sensor, bool predicted,
                             std::vector<TrackedObject*>& used) const
{
  std::vector<AssociatedModel> result{{&*background.volume (), T_world_sensor, 1.0}};
  used.clear ();
  for (const auto& object : objects.active ())
  {
    if (!predicted && object->state != ObjectState::Tracked)
      continue;
    used.push_back (object.get ());
    const Eigen::Isometry3d& T_world_object = predicted ? object->predicted () : object->T_world_object;
    result.push_back ({&object->volume, T_world_object.inverse () * T_world_sensor, uncounted_object});
  }
  return result;
}

bool
DynamicFusion::Impl::trackCamera (const FrameCloud& cloud, const RgbdFrame& frame)
{
  const double stamp = frame.stamp;
  camera_tracking.begin (cloud);
  if (!background.volume ())
  {
    last_frame = frame.index;
    camera_tracking.keep (cloud, T_world_camera);
    background.follow (cloud, T_world_camera);
    result.inlier_share = 1.0;
    return background.volume ().has_value ();
  }
  const double frames_passed = std::max (1.0, static_cast<double> (frame.index) - static_cast<double> (last_frame));
  std::vector<TrackedObject*> used;
  PoseEstimate estimate;
  bool good = false;
  for (const Eigen::Isometry3d& motion : {last_motion, Eigen::Isometry3d (Eigen::Isometry3d::Identity ())})
  {
    const Eigen::Isometry3d guess = T_world_camera * motion;
    estimate = camera_tracking.track (cloud, models (guess, true, used), used, guess, frames_passed);
    good = estimate.doubt.empty ();
    if (good || last_motion.isApprox (Eigen::Isometry3d::Identity (), 1e-9))
      break;
  }
  result.inlier_share = estimate.alignment.inlier_share;
  if (!good)
  {
    if (frames_lost == 0)
      log.add (stamp, "the camera is lost: ", estimate.doubt);
    ++frames_lost;
    last_motion = Eigen::Isometry3d::Identity ();
    return false;
  }
  if (frames_lost > 0)
    log.add (stamp, "the camera is found again after ", frames_lost, " frames");
  // What the surroundings do not tell must not go on by itself.
  const bool steady = frames_passed == 1.0 && estimate.observed_directions == all_directions;
  last_motion = steady ? Eigen::Isometry3d (T_world_camera.inverse () * estimate.T_model_camera)
                       : Eigen::Isometry3d::Identity ();
  T_world_camera = estimate.T_model_camera;
  camera_tracking.keep (cloud, T_world_camera);
  frames_lost = 0;
  last_frame = frame.index;
  background.follow (cloud, T_world_camera);
  return true;
}

FrameInstances
DynamicFusion::Impl::findInstances (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>& labels)
{
  if (!segmenter.isSet ())
    return {};
  const Image<std::uint8_t> moving = camera_tracking.moving ().image (cloud, labels, TrackedFrame::unassigned);
  ObservedFrame observed{frame, camera, cloud.points, T_world_camera, {}, labels, moving};
  for (const auto& object : objects.active ())
    if (object->state == ObjectState::Tracked)
      observed.T_world_object[object->id] = object->T_world_object;
  FrameInstances found = segmenter.see (observed, log);
  if (!found.mask || segmenter.isExact ())
    return found;
  ReconciledMask reconciled = reconcile (*found.mask, labels, moving, cloud);
  objects.judge (frame.stamp, reconciled, labels, log);
  attach (objects.moved (), labels, cloud, reconciled);
  found.classes = carryOver (found, reconciled.mask, cloud);
  found.mask = std::move (reconciled.mask);
  return found;
}

FrameSegmentation
DynamicFusion::Impl::segment (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>* mask)
{
  std::vector<TrackedObject*> used;
  const auto idsOf = [] (const std::vector<TrackedObject*>& objects) {
    std::vector<std::uint16_t> ids{0};
    for (const TrackedObject* object : objects)
      ids.push_back (static_cast<std::uint16_t> (object->id));
    return ids;
  };
  std::vector<AssociatedModel> known = models (T_world_camera, false, used);
  const bool exact = mask || segmenter.isExact ();
  // Masks that are not exact do not take back what joined wrongly.
  FrameSegmentation segmentation = segmentFrame (cloud, known, idsOf (used), association,
                                                 exact ? ObjectGrowth::Any : ObjectGrowth::Small);
  FrameInstances found;
  if (!mask)
    found = findInstances (frame, cloud, segmentation.labels);
  if (!exact)
    objects.uniteParts (frame.stamp, cloud, T_world_camera, segmentation.labels, found.mask, log);
  const bool shows_all = mask || !segmenter.isSet () || segmenter.findsAll ();
  if (found.mask)
    mask = &*found.mask;
  if (mask)
  {
    const MaskedFrame masked{frame.stamp, cloud, *mask, found.classes, T_world_camera, exact, shows_all};
    const std::set<int> before = objects.found ();
    const auto object_of = objects.readMask (masked, segmentation.labels, tracking, log);
    if (!exact)
      dropSmallComponents (cloud, object_of, *found.mask);
    known = models (T_world_camera, false, used);
    applyMask (cloud, *mask, object_of, known, idsOf (used), association, segmentation);
    for (const auto& [instance, id] : object_of)
      if (exact && before.count (id) == 0) // until now it was background
        background.volume ()->forget (cloud.depth, camera, T_world_camera, segmentation.labels, id);
    objects.grow (frame.stamp, cloud, T_world_camera, segmentation.labels, log);
    camera_tracking.ignore (cloud, *mask, FrameSegmenter::ignored, T_world_camera);
    result.masked = true;
  }
  camera_tracking.moving ().mark (cloud, segmentation.labels, TrackedFrame::unassigned);
  objects.tidy (frame.stamp, segmentation, log);
  objects.leaveToLost (cloud, T_world_camera, segmentation.labels);
  return segmentation;
}

void
DynamicFusion::Impl::integrate (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>& labels)
{
  TsdfPixels pixels;
  pixels.labels = &labels;
  TsdfVolume& room = *background.volume ();
  room.integrate (cloud.reliable, camera, T_world_camera, pixels);
  if (result.masked && room.options ().foreground)
    room.countForeground (cloud.reliable, camera, T_world_camera, labels, 0);
  if (objects.active ().empty ())
    return;
  const Image<std::uint16_t> wide = widened (labels, mask_border_px);
  if (frame.colour.pixels.size () == labels.pixels.size ())
    pixels.colours = &frame.colour;
  for (const auto& object : objects.active ())
  {
    if (object->state != ObjectState::Tracked)
      continue;
    pixels.label = static_cast<std::uint16_t> (object->id);
    const Eigen::Isometry3d T_object_camera = object->T_world_object.inverse () * T_world_camera;
    object->volume.integrate (cloud.reliable, camera, T_object_camera, pixels);
    object->volume.integrateFreeSpace (cloud.reliable, camera, T_object_camera, wide, pixels.label);
    if (result.masked)
      object->volume.countForeground (cloud.reliable, camera, T_object_camera, labels, pixels.label);
  }
}

void
DynamicFusion::Impl::report (const FrameSegmentation& segmentation)
{
  result.T_world_camera = T_world_camera;
  result.instances = segmentation.labels;
  for (const auto& object : objects.active ())
  {
    if (!object->confirmed)
      std::replace (result.instances.pixels.begin (), result.instances.pixels.end (),
                    static_cast<std::uint16_t> (object->id), TrackedFrame::unassigned);
    else if (object->state == ObjectState::Tracked)
      result.T_world_object[object->id] = object->T_world_object;
    result.lost += object->state == ObjectState::Lost;
  }
}

void
DynamicFusion::Impl::process (const RgbdFrame& frame, const Image<std::uint16_t>* mask)
{
  if (mask && (mask->width != camera.width || mask->height != camera.height))
    throw InvalidArgument ("the mask must be of the camera's size");
  result = TrackedFrame ();
  bool good = false;
  FrameCloud cloud;
  timed ("tracking", [&] {
    cloud = makeFrameCloud (frame.depth, camera, options.max_depth_m, options.smooth_depth, options.threads);
    if (frame.colour.pixels.size () == frame.depth.pixels.size ())
      addBrightness (frame.colour, cloud);
    if (static_cast<double> (cloud.readings) < min_readings_share * static_cast<double> (cloud.points.size ()))
    {
      log.add (frame.stamp, "there are hardly any readings: ", cloud.readings);
      ++frames_lost;
      last_motion = Eigen::Isometry3d::Identity ();
      return;
    }
    good = trackCamera (cloud, frame);
    if (!good)
      return;
    std::vector<TrackedObject*> used;
    const std::vector<AssociatedModel> expected = models (T_world_camera, true, used);
    trackObjects ({frame.stamp, cloud, T_world_camera}, expected, used, tracking, log);
  });
  if (!good)
  {
    for (const auto& object : objects.active ())
      ++object->frames_not_tracked;
    return;
  }
  FrameSegmentation segmentation;
  timed ("segmentation", [&] { segmentation = segment (frame, cloud, mask); });
  timed ("integration", [&] { integrate (frame, cloud, segmentation.labels); });
  report (segmentation);
}

DynamicFusion::DynamicFusion (const PinholeCamera& camera, const DynamicFusionOptions& options)
    : impl_ (std::make_unique<Impl> (camera, options))
{}

DynamicFusion::~DynamicFusion () = default;
DynamicFusion::DynamicFusion (DynamicFusion&& other) noexcept = default;
DynamicFusion& DynamicFusion::operator= (DynamicFusion&& other) noexcept = default;

void
DynamicFusion::setSegmenter (std::shared_ptr<FrameSegmenter> segmenter)
{
  impl_->segmenter.set (std::move (segmenter));
}

const TrackedFrame&
DynamicFusion::process (const RgbdFrame& frame, const Image<std::uint16_t>* mask)
{
  impl_->process (frame, mask);
  return impl_->result;
}

std::set<int>
DynamicFusion::objects () const
{
  std::set<int> ids;
  for (const auto& object : impl_->objects.active ())
    if (object->confirmed)
      ids.insert (object->id);
  return ids;
}

std::set<int>
DynamicFusion::foundObjects () const
{
  return impl_->objects.found ();
}

TriangleMesh
DynamicFusion::surfaceMesh (int id) const
{
  return impl_->objects.surfaceMesh (id);
}

std::optional<ClassScore>
DynamicFusion::objectClass (int id) const
{
  return impl_->objects.classOf (id);
}

TriangleMesh
DynamicFusion::backgroundMesh () const
{
  return impl_->background.volume () ? impl_->background.volume ()->surfaceMesh () : TriangleMesh ();
}

std::vector<std::string>
DynamicFusion::events () const
{
  return impl_->log.lines ();
}

const std::map<std::string, double>&
DynamicFusion::timings () const
{
  return impl_->timings;
}

} // namespace pcl::cosection
