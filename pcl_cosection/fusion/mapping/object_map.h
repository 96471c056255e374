// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_merging.h"
#include "pcl_cosection/fusion/event_log.h"
#include "pcl_cosection/fusion/fusion_setup.h"
#include "pcl_cosection/fusion/tracking/frame_cloud.h"
#include "tracked_object.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace pcl::cosection {

/** \brief All objects, and what is known of pairs of them. */
struct ObjectMap
{
  std::map<int, TrackedObject> by_id;
  ObjectPairs pairs;
  int next_id = 1;
  int next_dormant = 1; ///< TrackedObject::dormant_since

  /** \brief Ids of all objects but those that are not confirmed. */
  std::set<int> found () const;

  /** \brief Ids of objects that are tracked and have moved since they began. */
  std::set<int> moved () const;

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

/** \brief The reliable points of a label, sensor frame. */
std::vector<Eigen::Vector3f> pointsOf (const FrameCloud& cloud, const Image<std::uint16_t>& labels,
                                       std::uint16_t label);

std::vector<Eigen::Vector3f> transformed (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T);

/** \brief Grow the volumes of tracked objects so that they hold the points of their labels. */
void growVolumes (const PosedFrame& frame, const Image<std::uint16_t>& labels, int max_resolution, ObjectMap& objects,
                  EventLog& log);

/** \brief Erase what is probably no object; objects that were not seen for long become dormant.
 * \param[in] mean_probability of the pixels that an object explains, by label */
void pruneObjects (double stamp, const std::map<std::uint16_t, double>& mean_probability,
                   const DynamicFusionOptions& options, ObjectMap& objects, EventLog& log);

} // namespace pcl::cosection
