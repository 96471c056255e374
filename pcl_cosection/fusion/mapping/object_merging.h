// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/association/frame_mask.h"
#include "pcl_cosection/fusion/event_log.h"
#include "tracked_object.h"

#include <Eigen/Core>

#include <map>
#include <utility>

namespace pcl::cosection {

struct FusionSetup;
struct ObjectMap;
struct ReconciledMask;

/** \brief Whether two objects are parts of one, as unreliable masks may show parts of objects. */
struct ObjectPair
{
  int together = 0;         ///< masks that showed them as one instance
  int apart = 0;            ///< masks that showed them as two that touch
  Eigen::Vector3d place;    ///< of the second in the first when both were first tracked, metres
  Eigen::Vector3d start[2]; ///< of both, then, world frame
  int frames = 0;           ///< in which both were tracked
  double travel_m = 0.0;    ///< largest distance from its start of the one that moved less
  double drift_m = 0.0;     ///< largest distance of the second from its place in the first
  double tolerance_m = 0.0;
  bool two = false; ///< they were seen to move separately: they are two forever

  /** \brief Whether they touch and keep their places relative to each other while both move, or masks show them as one
   * more often than as two. */
  bool isOne () const;
};

using ObjectPairs = std::map<std::pair<int, int>, ObjectPair>; ///< by ids, the smaller one first

/** \brief Erase the pairs of an object. */
void forgetPairs (int id, ObjectPairs& pairs);

/** \brief Learn from a mask that is not exact: confirm objects that began with another one, or erase them.
 * \param[in] labels of this frame, by association */
void confirmObjects (double stamp, const ReconciledMask& mask, const LabelImage& labels, const FusionSetup& setup,
                     ObjectMap& objects, EventLog& log);

/** \brief Unite objects that are parts of one: the one with more pixels absorbs the other.
 * \param[in] labels of this frame, by association
 * \return by label of a part, which is erased, the label of its whole */
LabelMap uniteParts (double stamp, const LabelImage& labels, ObjectMap& objects, EventLog& log);

} // namespace pcl::cosection
