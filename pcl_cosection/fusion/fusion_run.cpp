// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_run.h"

#include "run_log.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t min_object_points = 100;
constexpr std::chrono::milliseconds patience (50); // until a cancellation is noticed

/** \brief Leave out objects of too few points, which are no failure: masks have outliers. */
void
leaveOutSmallObjects (FusionResult& result)
{
  for (auto object = result.objects.begin (); object != result.objects.end ();)
  {
    const std::size_t points = object->second.points;
    if (points >= min_object_points)
    {
      ++object;
      continue;
    }
    if (points > 0)
      result.warnings.push_back ("object " + std::to_string (object->first) + " was left out: it has only " +
                                 std::to_string (points) + " points in all keyframes; " +
                                 std::to_string (min_object_points) + " are needed");
    object = eraseObject (object, false, result);
  }
}

} // namespace

void
RunBackend::followUpdates (std::size_t waiting_views, const std::function<void ()>& report,
                           const SequenceFusion::KeyframeCallback& callback, double& seconds)
{
  if (!thread_)
    return;
  while (!thread_->wait (waiting_views, patience))
    report ();
  for (const BackendUpdate& update : thread_->takeUpdates ())
  {
    seconds += update.seconds;
    report ();
    if (callback)
      callback ({update.stamp, update.scene});
  }
}

FusionRun::FusionRun (const PinholeCamera& camera, const FusionOptions& options, std::unique_ptr<FrameContext> context)
    : camera_ (camera)
    , options_ (options)
    , context_ (std::move (context))
    , backend_ (options)
{
  for (const char* stage : {"read", "tracking", "raycast", "segmentation", "integration", "keyframes", "updates"})
    result_.timings_s[stage] = 0.0;
  result_.intrinsics = camera;
}

bool
FusionRun::takesKeyframe (const RgbdFrame& frame, const FrameKnowns& known)
{
  // It waits for a mask for as long as one may still come.
  const auto every = static_cast<std::size_t> (options_.keyframe_every);
  const std::size_t due = next_keyframe_.value_or (frame.index);
  const bool takes = frame.index >= due && known.instances && (known.masked || frame.index - due >= every);
  next_keyframe_ = takes ? due + (frame.index - due) / every * every + every : due;
  return takes;
}

bool
FusionRun::add (const RgbdFrame& frame, const SequenceFusion::FrameCallback& on_frame)
{
  // Poses and instances of the frame.
  last_is_keyframe_ = false;
  const FrameKnowns known = context_->next (frame);
  if (!known.T_world_camera)
    return false;
  ++result_.frames;
  result_.camera.push_back ({frame.stamp, *known.T_world_camera});

  // Points of the frame, if a keyframe is due.
  last_is_keyframe_ = takesKeyframe (frame, known);
  std::optional<Keyframe> keyframe;
  if (const ScopedSeconds timer (result_.timings_s["keyframes"]); last_is_keyframe_)
    keyframe = makeKeyframe (frame, camera_, *known.instances, *known.T_world_camera, options_.keyframe);

  // Surfaces and trajectories of objects.
  const CoSectionBackend::Poses T_world_object = context_->mapObjects (frame, known, keyframe ? &*keyframe : nullptr);
  for (const auto& [id, T] : T_world_object)
    result_.objects[id].trajectory.push_back ({frame.stamp, T});

  // Points and free space for the completion.
  if (keyframe)
  {
    ++result_.keyframes;
    countPoints (*keyframe, T_world_object);
  }
  if (const ScopedSeconds timer (result_.timings_s["keyframes"]); keyframe)
    backend_.addKeyframe (std::move (*keyframe), T_world_object);
  else
    backend_.addFrame (makeDepthView (frame.depth, camera_, *known.T_world_camera, options_.keyframe), T_world_object);

  if (!keyframe && known.masked)
    keepUnseen (frame, known, T_world_object);

  if (on_frame)
    on_frame ({frame, *known.T_world_camera, T_world_object, known.instances ? &*known.instances : nullptr,
               last_is_keyframe_, [this] (int id) { return context_->surfaceMesh (id); }});
  return true;
}

void
FusionRun::countPoints (const Keyframe& keyframe, const CoSectionBackend::Poses& T_world_object)
{
  for (const auto& [id, of_object] : keyframe.points)
  {
    points_.all += of_object.size ();
    if (id == 0)
      continue;
    if (T_world_object.count (id) > 0)
      result_.objects[id].points += of_object.size ();
    else
      points_.without_pose += of_object.size ();
  }
}

void
FusionRun::keepUnseen (const RgbdFrame& frame, const FrameKnowns& known, const CoSectionBackend::Poses& T_world_object)
{
  const auto showsEnough = [&] (const auto& object) {
    return result_.objects[object.first].points == 0 &&
           std::count (known.instances->pixels.begin (), known.instances->pixels.end (), object.first) >=
               static_cast<std::ptrdiff_t> (min_object_points);
  };
  if (!known.instances || std::none_of (T_world_object.begin (), T_world_object.end (), showsEnough))
    return;
  const ScopedSeconds timer (result_.timings_s["keyframes"]);
  Keyframe keyframe = makeKeyframe (frame, camera_, *known.instances, *known.T_world_camera, options_.keyframe);
  for (auto of_label = keyframe.points.begin (); of_label != keyframe.points.end ();)
    of_label = of_label->first == 0 || T_world_object.count (of_label->first) > 0 ? std::next (of_label)
                                                                                  : keyframe.points.erase (of_label);
  unseen_.emplace (std::move (keyframe), T_world_object);
}

void
FusionRun::addUnseen (CoSectionBackend& backend)
{
  if (!unseen_)
    return;
  const auto& [keyframe, T_world_object] = *unseen_;
  if (std::none_of (keyframe.points.begin (), keyframe.points.end (), [this] (const auto& of_label) {
        return of_label.first != 0 && result_.objects[of_label.first].points == 0;
      }))
    return;
  ++result_.keyframes;
  countPoints (keyframe, T_world_object);
  backend.addKeyframe (keyframe, T_world_object);
}

void
FusionRun::followUpdates (const std::function<void ()>& report, const SequenceFusion::KeyframeCallback& on_keyframe,
                          bool wait_for_all)
{
  const bool in_step = last_is_keyframe_ && options_.updates == KeyframeUpdates::InStep;
  backend_.followUpdates (wait_for_all || in_step ? 0 : options_.backend.max_views, report, on_keyframe,
                          result_.timings_s["updates"]);
}

FusionResult
FusionRun::complete (const ProgressCallback& progress)
{
  CoSectionBackend& backend = backend_.withoutUpdates ();
  addUnseen (backend);
  for (const int id : context_->wrongObjects ())
    backend.removeObject (id);
  FusionResult result = result_;
  {
    const ScopedSeconds timer (result.timings_s["final_solve"]);
    result.scene = backend.solve (progress);
  }
  for (const auto& [stage, seconds] : result.scene.timings_s)
    result.timings_s[stage] += seconds;
  result.kept_keyframes = backend.keyframes ();
  context_->finish (result);
  if (points_.without_pose > 0)
    result.warnings.push_back (std::to_string (points_.without_pose) +
                               " points of objects were left out: their trajectories have no pose for those frames");
  leaveOutSmallObjects (result);
  if (result.objects.empty () && context_->masks ().hasMasks ())
    result.why_no_object = context_->whyNoObject ();
  if (!result.why_no_object.empty ())
    result.warnings.push_back (result.why_no_object);
  result.warnings.insert (result.warnings.end (), result.scene.warnings.begin (), result.scene.warnings.end ());
  return result;
}

} // namespace pcl::cosection
