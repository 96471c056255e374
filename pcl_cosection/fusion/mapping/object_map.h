// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "object_merging.h"
#include "pcl_cosection/fusion/association/frame_segmentation.h"
#include "pcl_cosection/fusion/association/unreliable_mask.h"
#include "pcl_cosection/fusion/event_log.h"
#include "pcl_cosection/fusion/tracking/frame_cloud.h"
#include "pcl_cosection/fusion/tracking/pose_tracking.h"
#include "tracked_object.h"

#include "pcl_cosection/fusion/association/mask_matching.h"
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace pcl::cosection
{

/** \brief A frame in which objects are looked for. */
struct MaskedFrame
{
  double stamp;
  const FrameCloud& cloud;
  const Image<std::uint16_t>& mask;
  const std::map<std::uint16_t, ClassScore>& classes; ///< of its instances, where they are known
  Eigen::Isometry3d T_world_camera;
  bool exact;     ///< its instances are objects (see FrameSegmenter::isExact ())
  bool shows_all; ///< an object that should be in the mask and is not is probably none
};

/** \brief The objects that are known, and the decisions which there are. */
class ObjectMap
{
public:
  using Objects = std::vector<std::unique_ptr<TrackedObject>>;

  ObjectMap (const PinholeCamera& camera, const DynamicFusionOptions& options);

  /** \brief Those that are tracked or looked for, by ascending numbers. */
  const Objects& active () const { return active_; }

  /** \brief Numbers of all that were not given up as wrong. */
  std::set<int> found () const;

  /** \brief Numbers of those that are tracked and have moved since they began. */
  std::set<int> moved () const;

  /** \brief What was seen of one of them, its frame; empty if there is none of that number. */
  TriangleMesh surfaceMesh (int id) const;

  /** \brief What one of them is; nothing if that is not known, or there is none of that number. */
  std::optional<ClassScore> classOf (int id) const;

  /** \brief Match the instances of a mask with objects; count which were seen and which missed; look for lost ones
   * among instances that match none; begin new objects with the others.
   * \param[in] labels what shows which object by association
   * \return the object of each instance that has one */
  std::map<std::uint16_t, std::uint16_t> readMask (const MaskedFrame& frame, const Image<std::uint16_t>& labels,
                                                   PoseTracking& tracking, EventLog& log);

  /** \brief Learn from a mask that is not exact: confirm or give up what began with another one. */
  void judge (double stamp, const ReconciledMask& mask, const Image<std::uint16_t>& labels, EventLog& log);

  /** \brief Unite objects that are parts of one, whose volume gets to know without a mask, too, that they are.
   * \param[in,out] labels by association \param[in,out] mask there may be none */
  void uniteParts (double stamp, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
                   Image<std::uint16_t>& labels, std::optional<Image<std::uint16_t>>& mask, EventLog& log);

  /** \brief Give up what is probably no object, and stop looking for what was not seen for long. */
  void tidy (double stamp, const FrameSegmentation& segmentation, EventLog& log);

  /** \brief Give pixels of label 0 that may show a lost object to nobody. */
  void leaveToLost (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
                    Image<std::uint16_t>& labels) const;

  /** \brief Make room for what is labelled as an object's. */
  void grow (double stamp, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
             const Image<std::uint16_t>& labels, EventLog& log);

private:
  MaskMatches match (const MaskedFrame& frame, const Image<std::uint16_t>& labels) const;
  void countExistence (const MaskMatches& matches, bool shows_all);
  /** \brief Count the classes of instances for the objects that they show. */
  void countClasses (const MaskedFrame& frame, const std::map<std::uint16_t, std::uint16_t>& object_of);
  /** \brief Of a number, if it is not gone. */
  const TrackedObject* lookUp (int id) const;
  /** \brief The object that an instance shows, of those that are not tracked. */
  TrackedObject* findAgain (const MaskedFrame& frame, const std::vector<Eigen::Vector3f>& points,
                            std::uint16_t instance, PoseTracking& tracking);
  TrackedObject* create (const MaskedFrame& frame, const std::vector<Eigen::Vector3f>& points, std::uint16_t instance,
                         EventLog& log);
  /** \brief Whether a mask should show an object of which so much is in view. */
  bool isExpectedInMask (std::size_t pixels) const
  {
    constexpr double expected_share = 0.25; // of the pixels of a new object
    return static_cast<double> (pixels) > expected_share * static_cast<double> (min_pixels_);
  }
  /** \brief Erase one as if it had never been. */
  void erase (int id);
  void sortActive ();

  /** \brief What is left of an object. */
  struct GoneObject
  {
    TriangleMesh surface;
    std::optional<ClassScore> best_class;
  };

  DynamicFusionOptions options_;
  ObjectMerging merging_;
  std::size_t min_pixels_;
  TsdfOptions tsdf_;
  Objects active_;
  Objects dormant_;                // not seen for long, but they may come back
  std::map<int, GoneObject> gone_; // those before them, which are not looked for any more
  std::set<int> not_growing_;      // whose largest size was told
  int next_id_ = 1;
};

} // namespace pcl::cosection
