// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mask_reader.h"
#include "run_log.h"

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace pcl::cosection {

/** \brief The camera and the instances of a frame. */
struct FrameKnowns
{
  std::optional<Eigen::Isometry3d> T_world_camera; ///< nothing: the frame is left out
  /** \brief Id of the object per pixel, 0: background; empty: all is background. Nothing: it is not known. */
  std::optional<Image<std::uint16_t>> instances;
  bool masked = false; ///< a mask has part in the instances, or there are no masks at all
};

/** \brief Where poses and instances of frames come from: they are given, or found by tracking. */
class FrameContext
{
public:
  explicit FrameContext (MaskReader masks) : masks_ (std::move (masks)) {}

  virtual ~FrameContext () = default;

  /** \brief Go on to a frame. */
  virtual FrameKnowns next (const RgbdFrame& frame) = 0;

  /** \brief Map the objects in the frame, if that is not done yet.
   * \param[in,out] keyframe loses the points of labels without an object; null: the frame is no keyframe
   * \return T_world_object of the objects whose pose is known */
  virtual CoSectionBackend::Poses mapObjects (const RgbdFrame& frame, const FrameKnowns& known, Keyframe* keyframe) = 0;

  /** \brief Ids that keyframes had of what turned out to be no object of its own. */
  virtual std::set<int> wrongObjects () const { return {}; }

  /** \brief Surface of an object so far, object frame; empty without such an object. */
  virtual TriangleMesh surfaceMesh (int id) const = 0;

  /** \brief A few words for the progress; may be empty. */
  virtual std::string status () const { return ""; }

  /** \brief The masks of the frames so far. */
  const MaskReader& masks () const { return masks_; }

  /** \brief Why no object came of the masks, if none did. */
  virtual std::string whyNoObject () const = 0;

  /** \brief Add surfaces, times and messages. */
  virtual void finish (FusionResult& result) = 0;

protected:
  MaskReader masks_;
};

std::unique_ptr<FrameContext> makeKnownPoses (const KnownSequence& sequence, const FusionOptions& options);

/** \brief Frames of which poses are not known. */
struct TrackedFrames
{
  PinholeCamera camera;
  MaskSource masks; ///< empty: no frame has one
  std::shared_ptr<FrameSegmenter> segmenter;
  bool has_objects = false; ///< there will be masks, or there is a segmenter
};

std::unique_ptr<FrameContext> makeTrackedPoses (const TrackedFrames& frames, const FusionOptions& options);

std::unique_ptr<FrameContext> makeTrackedPoses (const TrackedSequence& sequence, const FusionOptions& options);

/** \brief Erase an object of a result. \param[in] completed erase its completion in any case, else only if it failed
 * \return the next object */
std::map<int, FusedObject>::iterator eraseObject (std::map<int, FusedObject>::iterator object, bool completed,
                                                  FusionResult& result);

} // namespace pcl::cosection
