// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/association/unreliable_mask.h"
#include "tracked_object.h"

#include <Eigen/Core>

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief Finds objects that are parts of one, where masks may show parts: those that touch and keep their places
 * relative to each other while both move, and those that masks show as one more often than as two. Those that were once
 * seen to move by themselves are two for good. */
class ObjectMerging
{
public:
  using Objects = std::vector<std::unique_ptr<TrackedObject>>;

  /** \brief Look at a mask. */
  void count (const ReconciledMask& mask);

  /** \brief Look at where objects are, in each frame. */
  void follow (const Objects& objects);

  /** \brief Two objects that are one; nothing: there are none. */
  std::optional<std::pair<int, int>> next () const;

  void forget (int id);

private:
  struct Pair
  {
    int together = 0; ///< masks
    int apart = 0;
    Eigen::Vector3d place;    ///< of the second in the first when both were first tracked, metres
    Eigen::Vector3d start[2]; ///< of both, then, in the world
    int frames = 0;           ///< in which both were tracked
    double travel_m = 0.0;    ///< of the one that moved less from its start, at most
    double drift_m = 0.0;     ///< of the second in the first, at most
    double tolerance_m = 0.0;
    bool two = false; ///< for good

    bool touch () const { return together + apart > 0; }
  };

  static bool isOne (const Pair& pair);

  std::map<std::pair<int, int>, Pair> pairs_;
};

} // namespace pcl::cosection
