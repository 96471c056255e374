// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/association/data_association.h"
#include "pcl_cosection/fusion/fusion_setup.h"
#include "pcl_cosection/fusion/run_log.h"
#include "tracked_object.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

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

/** \brief All objects, and what is known of pairs of them. */
struct ObjectMap
{
  std::map<int, TrackedObject> by_id;
  std::map<std::pair<int, int>, ObjectPair> pairs; ///< by ids, the smaller one first
  int next_id = 1;
  int next_dormant = 1;                         ///< TrackedObject::dormant_since
  std::map<std::uint16_t, std::string> refused; ///< why instances of given masks began no object
  std::set<std::uint16_t> shown;                ///< instances of given masks that have shown one

  /** \brief Ids of the objects for which \a condition (object) holds. */
  template <typename Condition> std::set<int> idsOf (Condition&& condition) const
  {
    std::set<int> ids;
    for (const auto& [id, object] : by_id)
      if (condition (object))
        ids.insert (id);
    return ids;
  }

  /** \brief Ids of all objects but those that are not confirmed. */
  std::set<int> found () const
  {
    return idsOf ([] (const TrackedObject& object) { return object.confirmed; });
  }

  /** \brief The object of an id; null without one. */
  const TrackedObject* find (int id) const;

  /** \brief Erase an object as if it had never been. */
  void erase (int id);
};

/** \brief The background and objects in a sensor's frame, for association. Refers to volumes and objects. */
struct SceneModels
{
  std::vector<AssociatedModel> models;       ///< the background first
  std::vector<const TrackedObject*> objects; ///< of the models after the first

  /** \brief Label of a model's pixels. */
  std::uint16_t label (std::size_t model) const
  {
    return model == 0 ? 0 : static_cast<std::uint16_t> (objects[model - 1]->id);
  }
};

/** \brief The background and all active objects where they are expected in the next frame. */
SceneModels expectedModels (const TsdfVolume& background, const ObjectMap& objects,
                            const Eigen::Isometry3d& T_world_camera);

/** \brief The background and the objects that are tracked, where they are. */
SceneModels trackedModels (const TsdfVolume& background, const ObjectMap& objects,
                           const Eigen::Isometry3d& T_world_camera);

/** \brief Learn from a mask that is not exact: confirm objects that began with another one, or erase them.
 * \param[in] labels of this frame, by association */
void confirmObjects (double stamp, const ReconciledMask& mask, const LabelImage& labels, const FusionSetup& setup,
                     ObjectMap& objects, EventLog& log);

/** \brief Unite objects that are parts of one: the one with more pixels absorbs the other.
 * \param[in] labels of this frame, by association
 * \return by label of a part, which is erased, the label of its whole */
LabelMap uniteParts (double stamp, const LabelImage& labels, ObjectMap& objects, EventLog& log);

/** \brief Erase what is probably no object; objects that were not seen for long become dormant.
 * \param[in] mean_probability of the pixels that an object explains, by label */
void pruneObjects (double stamp, const std::map<std::uint16_t, double>& mean_probability,
                   const DynamicFusionOptions& options, ObjectMap& objects, EventLog& log);

} // namespace pcl::cosection
