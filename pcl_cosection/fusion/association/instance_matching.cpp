// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "instance_matching.h"

#include "pcl_cosection/fusion/mapping/scene_volumes.h"
#include "pcl_cosection/fusion/tracking/object_tracking.h"
#include "pcl_cosection/tracking/surface_points.h"
#include "unassigned_components.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int last_id = TrackedFrame::unassigned - 1;

Eigen::Vector3d
centroid (const std::vector<Eigen::Vector3f>& points)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3f& p : points)
    sum += p.cast<double> ();
  return sum / static_cast<double> (std::max<std::size_t> (1, points.size ()));
}

/** \brief Match instances with tracked objects: by overlap, or by number where numbers are those of objects. */
MaskMatches
matchTracked (const FrameCloud& cloud, const FrameMask& mask, const LabelImage& labels,
              const DynamicFusionOptions& options, const ObjectMap& objects)
{
  Image<std::uint16_t> instances = mask.instances;
  LabelImage shown = labels;
  for (std::size_t n = 0; n < shown.pixels.size (); ++n)
  {
    const bool ignored = instances.pixels[n] == FrameSegmenter::ignored;
    if (ignored)
      instances.pixels[n] = 0;
    if (ignored || shown.pixels[n] == TrackedFrame::unassigned)
      shown.pixels[n] = 0;
  }
  MaskMatches matches = matchMasks (instances, shown, cloud.depth, options.min_mask_iou);
  if (mask.exact && !options.persistent_ids)
    return matches;
  matches.object_of.clear ();
  for (const auto& [id, object] : objects.by_id)
  {
    const auto instance = static_cast<std::uint16_t> (mask.exact ? object.mask_id : id);
    if (object.isTracked () && matches.instance_pixels.count (instance) > 0)
      matches.object_of[instance] = static_cast<std::uint16_t> (id);
  }
  return matches;
}

void
countExistence (const MaskMatches& matches, bool shows_all, const FusionSetup& setup, ObjectMap& objects)
{
  std::set<int> seen;
  for (const auto& [instance, object] : matches.object_of)
    seen.insert (object);
  for (auto& [id, object] : objects.by_id)
  {
    const auto pixels = matches.object_pixels.find (static_cast<std::uint16_t> (id));
    if (seen.count (id) > 0)
      ++object.seen;
    else if (shows_all && object.isTracked () && pixels != matches.object_pixels.end () &&
             setup.isExpectedInMask (pixels->second))
      ++object.missed;
  }
}

void
countClasses (const FrameMask& mask, const LabelMap& object_of, ObjectMap& objects)
{
  for (const auto& [instance, id] : object_of)
    if (const auto detected = mask.classes.find (instance); detected != mask.classes.end ())
      objects.by_id.at (id).classes.add (detected->second);
}

/** \brief Objects that are not tracked: active ones first, then dormant ones, by the time since when they are. */
std::vector<TrackedObject*>
missingObjects (ObjectMap& objects)
{
  std::vector<TrackedObject*> missing;
  for (auto& [id, object] : objects.by_id)
    if (object.volume && !object.isTracked ())
      missing.push_back (&object);
  const auto dormantSince = [] (const TrackedObject* o) { return o->isActive () ? 0 : o->dormant_since; };
  std::stable_sort (missing.begin (), missing.end (), [&] (const TrackedObject* a, const TrackedObject* b) {
    return dormantSince (a) < dormantSince (b);
  });
  return missing;
}

/** \brief The missing object that an instance shows; null: none. */
TrackedObject*
findAgain (const PosedFrame& frame, const std::vector<Eigen::Vector3f>& points, std::uint16_t instance,
           bool persistent_ids, SdfAlignment& alignment, ObjectMap& objects)
{
  const Eigen::Vector3d centre = centroid (points);
  TrackedObject* best = nullptr;
  PoseEstimate best_estimate;
  for (TrackedObject* object : missingObjects (objects))
  {
    if (persistent_ids && object->mask_id != instance)
      continue;
    // At its last pose in the world, and moved so that its centre is the instance's.
    const Eigen::Isometry3d T_camera_last = frame.T_world_camera.inverse () * object->T_world_object;
    Eigen::Isometry3d T_camera_moved = T_camera_last;
    T_camera_moved.pretranslate (centre - T_camera_last * centroid (surfacePoints (object->volume->field ())));
    for (const Eigen::Isometry3d& T_camera_object : {T_camera_last, T_camera_moved})
    {
      const PoseEstimate estimate = findObject (frame.cloud, points, *object->volume, T_camera_object.inverse (),
                                                alignment);
      if (estimate.isAccepted () && (!best || estimate.alignment.inlier_share > best_estimate.alignment.inlier_share))
      {
        best = object;
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
  return best;
}

/** \brief Begin an object with an instance; null: it is refused, and the log says why. */
TrackedObject*
beginObject (const PosedFrame& frame, const std::vector<Eigen::Vector3f>& points, std::uint16_t instance, bool exact,
             const FusionSetup& setup, ObjectMap& objects, EventLog& log)
{
  const DynamicFusionOptions& options = setup.options;
  const auto refuse = [&] (const auto&... reason) {
    const std::string why = toText (reason...);
    log.add (frame.stamp, "instance ", instance, " began no object: ", why);
    if (exact)
      objects.refused.try_emplace (instance, why);
    return nullptr;
  };
  if (points.size () < setup.min_object_pixels)
    return refuse ("it has ", points.size (), " reliable pixels; ", setup.min_object_pixels, " are needed");
  const double depth = centroid (points).z ();
  if (depth > options.max_object_depth_m)
    return refuse ("it is ", depth, " m away; at most ", options.max_object_depth_m, " m are allowed");
  const auto active = std::count_if (objects.by_id.begin (), objects.by_id.end (),
                                     [] (const auto& object) { return object.second.isActive (); });
  if (active >= options.max_objects)
    return refuse ("there are ", active, " objects already");
  const std::optional<VoxelGrid> grid = placeObjectVolume (points, frame.T_world_camera, options.object_resolution);
  if (!grid)
    return refuse ("its points have no extent");
  for (const auto& [id, object] : objects.by_id)
  {
    const double overlap = object.isActive () ? volumeOverlap (*grid, object.volume->grid (), object.T_world_object)
                                              : 0.0;
    if (overlap > options.max_volume_iou && !options.persistent_ids)
      return refuse ("its volume would be that of object ", id, " to ", 100.0 * overlap, " %");
  }
  const int id = options.persistent_ids ? instance : objects.next_id;
  if (id > last_id || objects.find (id))
    return refuse ("there is no number for it");
  objects.next_id = std::max (objects.next_id, id + 1);
  // The object's frame is the world's, moved to the centre of the volume.
  VoxelGrid local = *grid;
  local.origin_m.setConstant (-0.5 * local.voxel_size_m * (options.object_resolution - 1));
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity ();
  T_world_object.translation () = grid->origin_m - local.origin_m;
  TrackedObject& object = objects.by_id.try_emplace (id, id, local, setup.object_tsdf, T_world_object).first->second;
  object.confirmed = exact;
  object.mask_id = instance;
  object.seen = 1;
  object.range_m = depth;
  log.add (frame.stamp, "object ", id, " begins with instance ", instance, ": ", points.size (), " pixels, voxels of ",
           1000.0 * local.voxel_size_m, " mm");
  return &object;
}

} // namespace

MaskMatches
matchMasks (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& rendered, const Image<float>& depth,
            double min_iou)
{
  if (mask.pixels.size () != rendered.pixels.size () || mask.pixels.size () != depth.pixels.size ())
    throw InvalidArgument ("masks can be matched with an image of their own size only");
  MaskMatches matches;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> common;
  for (std::size_t n = 0; n < mask.pixels.size (); ++n)
  {
    const std::uint16_t instance = mask.pixels[n];
    const std::uint16_t object = rendered.pixels[n];
    if ((instance == 0 && object == 0) || !std::isfinite (depth.pixels[n]))
      continue;
    if (instance != 0)
      ++matches.instance_pixels[instance];
    if (object != 0)
      ++matches.object_pixels[object];
    if (instance != 0 && object != 0)
      ++common[{instance, object}];
  }
  std::vector<std::tuple<double, std::uint16_t, std::uint16_t>> pairs;
  for (const auto& [pair, pixels] : common)
  {
    const std::size_t either = matches.instance_pixels[pair.first] + matches.object_pixels[pair.second] - pixels;
    const double iou = static_cast<double> (pixels) / static_cast<double> (either);
    if (iou > min_iou)
      pairs.emplace_back (-iou, pair.first, pair.second);
  }
  std::sort (pairs.begin (), pairs.end ());
  std::set<std::uint16_t> taken;
  for (const auto& [iou, instance, object] : pairs)
    if (matches.object_of.count (instance) == 0 && taken.insert (object).second)
      matches.object_of[instance] = object;
  return matches;
}

MatchedInstances
matchInstances (const PosedFrame& frame, const FrameMask& mask, const LabelImage& labels, const FusionSetup& setup,
                SdfAlignment& alignment, ObjectMap& objects, EventLog& log)
{
  const std::set<int> found_before = objects.found ();
  MaskMatches matches = matchTracked (frame.cloud, mask, labels, setup.options, objects);
  const std::set<std::uint16_t> cut = mask.exact ? std::set<std::uint16_t> ()
                                                 : cutInstances (mask.instances, frame.cloud);
  countExistence (matches, mask.shows_all, setup, objects);
  for (const auto& [instance, pixels] : matches.instance_pixels)
  {
    if (matches.object_of.count (instance) > 0)
      continue;
    const std::vector<Eigen::Vector3f> points = frame.cloud.pointsOf (mask.instances, instance);
    if (!mask.exact && (cut.count (instance) > 0 || points.size () < setup.min_object_pixels))
      continue; // not worth a line in the log: there are many
    const TrackedObject* object = findAgain (frame, points, instance, setup.options.persistent_ids, alignment, objects);
    if (object)
      log.add (frame.stamp, "object ", object->id, " is found again as instance ", instance);
    else
      object = beginObject (frame, points, instance, mask.exact, setup, objects, log);
    if (object)
      matches.object_of[instance] = static_cast<std::uint16_t> (object->id);
  }
  countClasses (mask, matches.object_of, objects);
  if (mask.exact)
    for (const auto& [instance, object] : matches.object_of)
      objects.shown.insert (instance);
  MatchedInstances result{std::move (matches.object_of), {}};
  for (const auto& [instance, id] : result.object_of)
    if (mask.exact && found_before.count (id) == 0)
      result.new_objects.push_back (id);
  return result;
}

} // namespace pcl::cosection
