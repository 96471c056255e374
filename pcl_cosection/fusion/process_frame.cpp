// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "process_frame.h"

#include "pcl_cosection/fusion/association/frame_labels.h"
#include "pcl_cosection/fusion/association/instance_matching.h"
#include "pcl_cosection/fusion/association/unreliable_mask.h"
#include "pcl_cosection/fusion/mapping/scene_volumes.h"
#include "pcl_cosection/fusion/tracking/object_tracking.h"

#include <utility>

namespace pcl::cosection {
namespace {

TrackedFrame
trackedFrame (const PosedFrame& frame, const LabelImage& labels, double inlier_share, bool masked,
              const ObjectMap& objects)
{
  TrackedFrame result;
  result.T_world_camera = frame.T_world_camera;
  result.instances = withoutUnconfirmed (labels, objects);
  result.masked = masked;
  result.inlier_share = inlier_share;
  for (const auto& [id, object] : objects.by_id)
  {
    if (object.confirmed && object.isTracked ())
      result.T_world_object[id] = object.T_world_object;
    result.lost += object.state == ObjectState::Lost;
  }
  return result;
}

/** \brief The result without the camera's pose: no object is tracked. */
TrackedFrame
untrackedFrame (double inlier_share, ObjectMap& objects)
{
  for (auto& [id, object] : objects.by_id)
    if (object.isActive ())
      ++object.frames_not_tracked;
  TrackedFrame result;
  result.inlier_share = inlier_share;
  return result;
}

/** \brief Labels by the instances of a frame; objects begin with them, and pixels to be ignored count as moving. */
LabelImage
labelsByMask (const PosedFrame& frame, const LabelImage& associated, const FrameMask& mask, const FusionSetup& setup,
              FusionState& state)
{
  const FrameCloud& cloud = frame.cloud;
  const MatchedInstances matched = matchInstances (frame, mask, associated, setup, state.alignment, state.objects,
                                                   state.log);
  const Image<std::uint16_t> instances = mask.exact ? mask.instances
                                                    : dropIsolated (mask.instances, matched.object_of, cloud);
  const LabelImage labels = applyMask (associated, instances, matched.object_of, cloud,
                                       trackedModels (*state.background, state.objects, frame.T_world_camera),
                                       setup.association);
  for (const std::uint16_t label : matched.new_objects)
    state.background->forget (cloud.depth, setup.camera, frame.T_world_camera, labels, label);
  state.camera.moving = withIgnored (std::move (state.camera.moving), cloud, instances, frame.T_world_camera);
  return labels;
}

} // namespace

TrackedFrame
processFrame (const RgbdFrame& frame, const Image<std::uint16_t>* given_mask, const FusionSetup& setup,
              FusionState& state)
{
  std::optional<ScopedSeconds> stage (state.timings_s["tracking"]);
  // Points p = z K^-1 (u, v, 1), with z from a bilateral filter.
  const FrameCloud cloud = makeFrameCloud (frame, setup.camera, setup.options);

  // Camera pose, E- and M-step of EM-Fusion: argmin_T sum_i P_i (m) rho (d_m (T p_i)) for the model m of the
  // background, see associatePixels () and SdfAlignment. The background's volume goes with the camera.
  CameraStep step = trackCamera (frame, cloud, given_mask, state.background, state.objects, state.camera, setup,
                                 state.alignment, state.log);
  state.camera = std::move (step.camera);
  const PosedFrame posed{frame.stamp, cloud, state.camera.T_world_camera};
  if (step.tracked)
    followBackground (posed, setup, state.background);
  if (!step.tracked || !state.background)
    return untrackedFrame (step.inlier_share, state.objects);

  // Object poses: the same for the model of each object, relative to the camera.
  trackObjects (posed, *state.background, {setup.association, state.alignment}, state.objects, state.log);
  stage.emplace (state.timings_s["segmentation"]);

  // Labels by association, argmax_m P_i (m) (EM-Fusion, Section 3.2). Models are projected, not ray cast. Then objects
  // grow over pixels that no model explains: by small components only, unless a mask or an exact segmenter corrects it.
  const SceneModels scene = trackedModels (*state.background, state.objects, posed.T_world_camera);
  const PixelAssociation associated = associatePixels (cloud, scene, setup.association);
  const bool exact = given_mask || state.segmenter.isExact ();
  const LabelImage grown = growObjects (associated, cloud, scene, setup.association,
                                        exact ? ObjectGrowth::Any : ObjectGrowth::Small);

  // Instances: of the mask that is given, or by the segmenter; parts of one object are united.
  std::optional<FrameMask> mask = given_mask ? FrameMask{*given_mask, {}}
                                             : detectInstances (frame, posed, grown, state.camera.moving, setup,
                                                                state.objects, state.segmenter, state.log);
  const LabelMap whole_of = exact ? LabelMap () : uniteParts (frame.stamp, grown, state.objects, state.log);
  const LabelImage united = relabelled (grown, whole_of);
  if (mask)
    mask->instances = relabelled (std::move (mask->instances), whole_of);

  // Objects of the instances: matched, found again or new. The mask overrules association. Without one, an object that
  // has absorbed others has their pixels as its foreground.
  const LabelImage masked = mask ? labelsByMask (posed, united, *mask, setup, state) : united;
  if (mask || !whole_of.empty ())
    growVolumes (posed, masked, setup.options.max_object_resolution, state.objects, state.log);
  if (!mask)
    countAbsorbed (posed, masked, whole_of, state.objects);

  // Final labels: things that move by themselves, and where lost objects may be, belong to nothing known. Objects that
  // are probably none are erased.
  const LabelImage resting = withoutMoving (masked, state.camera.moving, cloud);
  pruneObjects (frame.stamp, associated.mean_probability, setup.options, state.objects, state.log);
  const LabelImage labels = withoutLost (resting, state.objects, posed);
  stage.emplace (state.timings_s["integration"]);

  // Integration of depth, and foreground counts where there is a mask.
  integrateFrame (frame, posed, labels, mask.has_value (), *state.background, state.objects);
  TrackedFrame tracked = trackedFrame (posed, labels, step.inlier_share, mask.has_value (), state.objects);
  tracked.only_objects = state.camera.only_objects;
  return tracked;
}

} // namespace pcl::cosection
