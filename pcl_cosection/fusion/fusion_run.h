// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_context.h"

#include <pcl/cosection/fusion/co_section_backend.h>
#include <pcl/cosection/fusion/sequence_fusion.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief The back end, in a thread beside the front end if there are updates at keyframes. */
class RunBackend
{
public:
  explicit RunBackend (const FusionOptions& options) : backend_ (options.backend)
  {
    if (options.updates != KeyframeUpdates::None)
      thread_.emplace (backend_);
  }

  void addKeyframe (Keyframe keyframe, const CoSectionBackend::Poses& T_world_object)
  {
    if (thread_)
      thread_->addKeyframe (std::move (keyframe), T_world_object);
    else
      backend_.addKeyframe (keyframe, T_world_object);
  }

  void addFrame (DepthView view, const CoSectionBackend::Poses& T_world_object)
  {
    if (thread_)
      thread_->addFrame (std::move (view), T_world_object);
    else
      backend_.addFrame (std::move (view), T_world_object);
  }

  /** \brief Pass updates on, when no more than so many views wait for the back end; 0: when all updates are done.
   * \param[in] report called while it waits; may throw */
  void followUpdates (std::size_t waiting_views, const std::function<void ()>& report,
                      const SequenceFusion::KeyframeCallback& callback, double& seconds);

  /** \brief The back end with all views, as if there had been no updates. */
  CoSectionBackend& withoutUpdates ()
  {
    thread_.reset ();
    backend_.forgetUpdates ();
    return backend_;
  }

private:
  CoSectionBackend backend_;
  std::optional<BackendThread> thread_;
};

/** \brief Goes through frames one by one, and completes everything that they show. */
class FusionRun
{
public:
  /** \brief Keeps references to the options. */
  FusionRun (const PinholeCamera& camera, const FusionOptions& options, std::unique_ptr<FrameContext> context);

  /** \brief Find the poses and instances of a frame and use it. \return whether it was used */
  bool add (const RgbdFrame& frame, const SequenceFusion::FrameCallback& on_frame);

  /** \brief Pass on the updates that followed the last frame. \param[in] report called while it waits; may throw */
  void followUpdates (const std::function<void ()>& report, const SequenceFusion::KeyframeCallback& on_keyframe,
                      bool wait_for_all);

  /** \brief Complete everything from all views, with what the frames have left. \throws Cancelled */
  FusionResult complete (const ProgressCallback& progress);

  const FrameContext& context () const { return *context_; }

  /** \brief What the frames have left so far. */
  FusionResult& result () { return result_; }

  /** \brief How many points all keyframes have. */
  std::size_t points () const { return points_.all; }

private:
  /** \brief Numbers of points in all keyframes. */
  struct KeyframePoints
  {
    std::size_t all = 0;
    std::size_t without_pose = 0; ///< of objects whose pose is not known in the keyframe
  };

  /** \brief Whether a keyframe is due, and what a frame knows is enough for one. */
  bool takesKeyframe (const RgbdFrame& frame, const FrameKnowns& known);

  void countPoints (const Keyframe& keyframe, const CoSectionBackend::Poses& T_world_object);

  /** \brief Keep what a frame between keyframes shows of objects that are in none so far. */
  void keepUnseen (const RgbdFrame& frame, const FrameKnowns& known, const CoSectionBackend::Poses& T_world_object);

  /** \brief A further keyframe of objects that are in no other one, as those that began after the last. */
  void addUnseen (CoSectionBackend& backend);

  const PinholeCamera camera_;
  const FusionOptions& options_;
  const std::unique_ptr<FrameContext> context_;
  RunBackend backend_;
  FusionResult result_;
  KeyframePoints points_;
  std::optional<std::size_t> next_keyframe_; // index of the frame from which on one is due
  bool last_is_keyframe_ = false;
  std::optional<std::pair<Keyframe, CoSectionBackend::Poses>> unseen_;
};

} // namespace pcl::cosection
