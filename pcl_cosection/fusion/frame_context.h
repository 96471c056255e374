// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief What is known of the frames of a sequence, one after the other: given, or found out by tracking. */
class FrameContext
{
public:
  virtual ~FrameContext () = default;

  /** \brief Go on to a frame. \return T_world_camera; nothing: the frame is left out */
  virtual std::optional<Eigen::Isometry3d> next (const RgbdFrame& frame) = 0;

  /** \brief Instance of each pixel of the frame, 0: background, empty: all is. Nothing: they are not known. */
  virtual const std::optional<Image<std::uint16_t>>& instances () const = 0;

  /** \brief Whether points may be taken from the frame. \param[in] overdue since how many frames they should be */
  virtual bool isFitForKeyframe (std::size_t overdue) const = 0;

  /** \brief Look at the points of the frame before they are used, with \a T_world_camera. */
  virtual void look (Keyframe& keyframe) = 0;

  /** \brief T_world_object of the objects that are known in the frame. */
  virtual CoSectionBackend::Poses poses () const = 0;

  /** \brief Numbers that keyframes had, of what turned out to be no object of its own. */
  virtual std::set<int> wrongObjects () const { return {}; }

  /** \brief Map what is seen of the objects, if that is not done. */
  virtual void map (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera) = 0;

  /** \brief What was seen of an object so far, its frame; empty if nothing. */
  virtual TriangleMesh seen (int id) const = 0;

  /** \brief A few words for who waits; may be empty. */
  virtual std::string status () const = 0;

  /** \brief Lines about masks that could not be read. */
  virtual std::vector<std::string> maskWarnings () const = 0;

  /** \brief Add what is known beside the completion. */
  virtual void finish (FusionResult& result) = 0;
};

std::unique_ptr<FrameContext> makeKnownPoses (const KnownSequence& sequence, const FusionOptions& options);

std::unique_ptr<FrameContext> makeTrackedPoses (const TrackedSequence& sequence, const FusionOptions& options);

/** \brief Reads masks, and remembers what was wrong with them. */
class MaskReader
{
public:
  /** \param[in] masks null: there are none */
  explicit MaskReader (const MaskSequence* masks) : masks_ (masks) {}

  /** \brief The mask of a frame; nothing if it has none or it is damaged. */
  std::optional<Image<std::uint16_t>> read (const RgbdFrame& frame);

  std::vector<std::string> warnings () const;

private:
  const MaskSequence* masks_;
  std::vector<std::string> warnings_;
  std::size_t more_ = 0;
};

/** \brief Adds the time that something takes. */
template <typename Function>
void
addSeconds (double& seconds, Function&& f)
{
  const auto start = std::chrono::steady_clock::now ();
  f ();
  seconds += std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
}

} // namespace pcl::cosection
