// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "object_map.h"

#include "pcl_cosection/fusion/association/unassigned_components.h"

#include "pcl_cosection/tracking/surface_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr double standard_pixels = 640.0 * 480.0;
constexpr int frames_until_dormant = 60;
constexpr std::size_t max_dormant = 16;
constexpr int last_id = TrackedFrame::unassigned - 1;

Eigen::Vector3d
centroid (const std::vector<Eigen::Vector3f>& points)
{
  const Eigen::Vector3d sum = std::accumulate (
      points.begin (), points.end (), Eigen::Vector3d (0.0, 0.0, 0.0),
      [] (const Eigen::Vector3d& s, const Eigen::Vector3f& p) -> Eigen::Vector3d { return s + p.cast<double> (); });
  return sum / static_cast<double> (std::max<std::size_t> (1, points.size ()));
}

double
meanDepth (const std::vector<Eigen::Vector3f>& points)
{
  return centroid (points).z ();
}

std::vector<Eigen::Vector3f>
pointsOf (const FrameCloud& cloud, const Image<std::uint16_t>& labels, std::uint16_t label)
{
  std::vector<Eigen::Vector3f> points;
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (labels.pixels[n] == label && std::isfinite (cloud.reliable.pixels[n]))
      points.push_back (cloud.points[n]);
  return points;
}

std::vector<Eigen::Vector3f>
transformed (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T)
{
  std::vector<Eigen::Vector3f> result (points.size ());
  std::transform (points.begin (), points.end (), result.begin (), [&T] (const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return (T * p.cast<double> ()).cast<float> ();
  });
  return result;
}

} // namespace

ObjectMap::ObjectMap (const PinholeCamera& camera, const DynamicFusionOptions& options) : options_ (options)
{
  const double share = static_cast<double> (camera.width) * camera.height / standard_pixels;
  min_pixels_ = static_cast<std::size_t> (std::max (1.0, std::round (options.min_object_pixels * share)));
  tsdf_.truncation_vox = options.object_truncation_vox;
  tsdf_.max_weight = options.max_weight;
  tsdf_.colour = true;
  tsdf_.foreground = true;
  tsdf_.threads = options.threads;
}

std::set<int>
ObjectMap::found () const
{
  std::set<int> ids;
  for (const Objects* objects : {&active_, &dormant_})
    for (const auto& object : *objects)
      if (object->confirmed)
        ids.insert (object->id);
  for (const auto& [id, object] : gone_)
    ids.insert (id);
  return ids;
}

std::set<int>
ObjectMap::moved () const
{
  std::set<int> ids;
  for (const auto& object : active_)
    if (object->state == ObjectState::Tracked && object->hasMoved ())
      ids.insert (object->id);
  return ids;
}

const TrackedObject*
ObjectMap::lookUp (int id) const
{
  for (const Objects* objects : {&active_, &dormant_})
    for (const auto& object : *objects)
      if (object->id == id)
        return object.get ();
  return nullptr;
}

TriangleMesh
ObjectMap::surfaceMesh (int id) const
{
  if (const TrackedObject* object = lookUp (id))
    return object->volume.surfaceMesh ();
  const auto gone = gone_.find (id);
  return gone != gone_.end () ? gone->second.surface : TriangleMesh ();
}

std::optional<ClassScore>
ObjectMap::classOf (int id) const
{
  if (const TrackedObject* object = lookUp (id))
    return object->classes.best ();
  const auto gone = gone_.find (id);
  return gone != gone_.end () ? gone->second.best_class : std::nullopt;
}

MaskMatches
ObjectMap::match (const MaskedFrame& frame, const Image<std::uint16_t>& labels) const
{
  Image<std::uint16_t> mask = frame.mask;
  Image<std::uint16_t> rendered = labels;
  for (std::size_t n = 0; n < rendered.pixels.size (); ++n)
  {
    const bool ignored = mask.pixels[n] == FrameSegmenter::ignored;
    if (ignored)
      mask.pixels[n] = 0;
    if (ignored || rendered.pixels[n] == TrackedFrame::unassigned)
      rendered.pixels[n] = 0;
  }
  MaskMatches matches = matchMasks (mask, rendered, frame.cloud.depth, options_.min_mask_iou);
  if (!frame.exact) // numbers are those of objects, as far as there are any
  {
    matches.object_of.clear ();
    for (const auto& object : active_)
      if (object->state == ObjectState::Tracked &&
          matches.instance_pixels.count (static_cast<std::uint16_t> (object->id)) > 0)
        matches.object_of[static_cast<std::uint16_t> (object->id)] = static_cast<std::uint16_t> (object->id);
  }
  else if (options_.persistent_ids)
  {
    matches.object_of.clear ();
    for (const auto& [instance, pixels] : matches.instance_pixels)
      for (const auto& object : active_)
        if (object->mask_id == instance && object->state == ObjectState::Tracked)
          matches.object_of[instance] = static_cast<std::uint16_t> (object->id);
  }
  return matches;
}

void
ObjectMap::countExistence (const MaskMatches& matches, bool shows_all)
{
  std::set<int> seen;
  for (const auto& [instance, object] : matches.object_of)
    seen.insert (object);
  for (const auto& object : active_)
  {
    const auto pixels = matches.object_pixels.find (static_cast<std::uint16_t> (object->id));
    if (seen.count (object->id) > 0)
      ++object->seen;
    else if (shows_all && object->state == ObjectState::Tracked && pixels != matches.object_pixels.end () &&
             isExpectedInMask (pixels->second))
      ++object->missed;
  }
}

void
ObjectMap::countClasses (const MaskedFrame& frame, const std::map<std::uint16_t, std::uint16_t>& object_of)
{
  for (const auto& object : active_)
    for (const auto& [instance, id] : object_of)
      if (const auto detected = frame.classes.find (instance); id == object->id && detected != frame.classes.end ())
        object->classes.add (detected->second);
}

TrackedObject*
ObjectMap::findAgain (const MaskedFrame& frame, const std::vector<Eigen::Vector3f>& points, std::uint16_t instance,
                      PoseTracking& tracking)
{
  const Eigen::Vector3d centre = centroid (points);
  TrackedObject* best = nullptr;
  PoseEstimate best_estimate;
  for (Objects* objects : {&active_, &dormant_})
    for (const auto& object : *objects)
    {
      if (object->state == ObjectState::Tracked || (options_.persistent_ids && object->mask_id != instance))
        continue;
      // Where it was last, relative to the world; and with its centre where that of the instance is.
      const Eigen::Isometry3d T_camera_last = frame.T_world_camera.inverse () * object->T_world_object;
      Eigen::Isometry3d T_camera_moved = T_camera_last;
      T_camera_moved.pretranslate (centre - T_camera_last * centroid (surfacePoints (object->volume.field ())));
      for (const Eigen::Isometry3d& T_camera_object : {T_camera_last, T_camera_moved})
      {
        const PoseEstimate estimate = tracking.findObject (frame.cloud, points, object->volume,
                                                           T_camera_object.inverse ());
        if (estimate.doubt.empty () &&
            (!best || estimate.alignment.inlier_share > best_estimate.alignment.inlier_share))
        {
          best = object.get ();
          best_estimate = estimate;
        }
      }
    }
  if (!best)
    return nullptr;
  best->moveTo (frame.T_world_camera * best_estimate.T_model_camera.inverse ());
  best->last_motion = Eigen::Isometry3d::Identity ();
  best->state = ObjectState::Tracked;
  best->frames_not_tracked = 0;
  ++best->seen;
  const auto dormant = std::find_if (dormant_.begin (), dormant_.end (),
                                     [best] (const auto& object) { return object.get () == best; });
  if (dormant != dormant_.end ())
  {
    active_.push_back (std::move (*dormant));
    dormant_.erase (dormant);
    sortActive ();
  }
  return best;
}

TrackedObject*
ObjectMap::create (const MaskedFrame& frame, const std::vector<Eigen::Vector3f>& points, std::uint16_t instance,
                   EventLog& log)
{
  const auto refuse = [&] (const auto&... reason) {
    log.add (frame.stamp, "instance ", instance, " began no object: ", reason...);
    return nullptr;
  };
  if (points.size () < min_pixels_)
    return refuse ("it has ", points.size (), " reliable pixels; ", min_pixels_, " are needed");
  const double depth = meanDepth (points);
  if (depth > options_.max_object_depth_m)
    return refuse ("it is ", depth, " m away; at most ", options_.max_object_depth_m, " m are allowed");
  if (active_.size () >= static_cast<std::size_t> (options_.max_objects))
    return refuse ("there are ", active_.size (), " objects already");
  const std::optional<VoxelGrid> grid = placeObjectVolume (transformed (points, frame.T_world_camera),
                                                           options_.object_resolution);
  if (!grid)
    return refuse ("its points have no extent");
  for (const auto& object : active_)
  {
    const double overlap = volumeOverlap (*grid, Eigen::Isometry3d::Identity (), object->volume.grid (),
                                          object->T_world_object);
    if (overlap > options_.max_volume_iou && !options_.persistent_ids)
      return refuse ("its volume would be that of object ", object->id, " to ", 100.0 * overlap, " %");
  }
  const int id = options_.persistent_ids ? instance : next_id_;
  if (id > last_id || found ().count (id) > 0)
    return refuse ("there is no number for it");
  next_id_ = std::max (next_id_, id + 1);
  // The object's frame is that of the world, moved to the centre of the volume.
  VoxelGrid local = *grid;
  local.origin_m.setConstant (-0.5 * local.voxel_size_m * (options_.object_resolution - 1));
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity ();
  T_world_object.translation () = grid->origin_m - local.origin_m;
  active_.push_back (std::make_unique<TrackedObject> (id, local, tsdf_, T_world_object));
  active_.back ()->confirmed = frame.exact;
  active_.back ()->mask_id = instance;
  active_.back ()->seen = 1;
  active_.back ()->range_m = depth;
  log.add (frame.stamp, "object ", id, " begins with instance ", instance, ": ", points.size (), " pixels, voxels of ",
           1000.0 * local.voxel_size_m, " mm");
  TrackedObject* created = active_.back ().get ();
  sortActive ();
  return created;
}

void
ObjectMap::sortActive ()
{
  std::sort (active_.begin (), active_.end (), [] (const auto& a, const auto& b) { return a->id < b->id; });
}

std::map<std::uint16_t, std::uint16_t>
ObjectMap::readMask (const MaskedFrame& frame, const Image<std::uint16_t>& labels, PoseTracking& tracking,
                     EventLog& log)
{
  MaskMatches matches = match (frame, labels);
  const std::set<std::uint16_t> cut = frame.exact ? std::set<std::uint16_t> () : cutInstances (frame.mask, frame.cloud);
  countExistence (matches, frame.shows_all);
  for (const auto& [instance, pixels] : matches.instance_pixels)
  {
    if (matches.object_of.count (instance) > 0)
      continue;
    const std::vector<Eigen::Vector3f> points = pointsOf (frame.cloud, frame.mask, instance);
    if (!frame.exact && (cut.count (instance) > 0 || points.size () < min_pixels_))
      continue; // there are many
    const TrackedObject* object = findAgain (frame, points, instance, tracking);
    if (object)
      log.add (frame.stamp, "object ", object->id, " is found again as instance ", instance);
    else
      object = create (frame, points, instance, log);
    if (object)
      matches.object_of[instance] = static_cast<std::uint16_t> (object->id);
  }
  countClasses (frame, matches.object_of);
  return matches.object_of;
}

void
ObjectMap::tidy (double stamp, const FrameSegmentation& segmentation, EventLog& log)
{
  for (auto i = active_.begin (); i != active_.end ();)
  {
    TrackedObject& object = **i;
    const auto mean = segmentation.mean_probability.find (static_cast<std::uint16_t> (object.id));
    const bool unlikely = object.existence () < options_.min_existence;
    const bool unrelated = object.state == ObjectState::Tracked && mean != segmentation.mean_probability.end () &&
                           mean->second < options_.min_association;
    const bool gone = object.frames_not_tracked > frames_until_dormant;
    if (!object.confirmed && object.state != ObjectState::Tracked)
    {
      merging_.forget (object.id);
      i = active_.erase (i);
      continue;
    }
    if (!unlikely && !unrelated && !gone)
    {
      ++i;
      continue;
    }
    if (unlikely)
      log.add (stamp, "object ", object.id, " is given up: it was in ", object.seen, " of ",
               object.seen + object.missed, " masks in which it should be");
    else if (unrelated)
      log.add (stamp, "object ", object.id, " is given up: its pixels are its own with a probability of ", mean->second,
               " only");
    else
    {
      log.add (stamp, "object ", object.id, " is no longer looked for: it was not seen for ", object.frames_not_tracked,
               " frames");
      dormant_.push_back (std::move (*i));
      if (dormant_.size () > max_dormant)
      {
        const TrackedObject& oldest = *dormant_.front ();
        gone_[oldest.id] = {oldest.volume.surfaceMesh (), oldest.classes.best ()};
        dormant_.erase (dormant_.begin ());
      }
      i = active_.erase (i);
      continue;
    }
    merging_.forget (object.id);
    i = active_.erase (i);
  }
}

void
ObjectMap::leaveToLost (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
                        Image<std::uint16_t>& labels) const
{
  for (const auto& object : active_)
    if (object->state == ObjectState::Lost)
      for (std::size_t n = 0; n < cloud.points.size (); ++n)
      {
        const Eigen::Vector3d p = T_world_camera * cloud.points[n].cast<double> ();
        const auto cell = object->volume.sample<float> (
            Eigen::Vector3f ((object->T_world_object.inverse () * p).cast<float> ()));
        if (labels.pixels[n] == 0 && cell && cell->value () < 0.5 * object->volume.truncation ())
          labels.pixels[n] = TrackedFrame::unassigned;
      }
}

void
ObjectMap::grow (double stamp, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
                 const Image<std::uint16_t>& labels, EventLog& log)
{
  for (const auto& object : active_)
  {
    if (object->state != ObjectState::Tracked)
      continue;
    const std::vector<Eigen::Vector3f> points = transformed (
        pointsOf (cloud, labels, static_cast<std::uint16_t> (object->id)),
        object->T_world_object.inverse () * T_world_camera);
    const Eigen::Vector3i before = object->volume.grid ().dims;
    if (!growObjectVolume (object->volume, points, options_.max_object_resolution) &&
        not_growing_.insert (object->id).second)
      log.add (stamp, "object ", object->id, " is larger than ", options_.max_object_resolution,
               " voxels: the rest is left out");
    const Eigen::Vector3i& now = object->volume.grid ().dims;
    if (now != before)
      log.add (stamp, "the volume of object ", object->id, " grows to ", now.x (), " x ", now.y (), " x ", now.z (),
               " voxels");
  }
}

} // namespace pcl::cosection
