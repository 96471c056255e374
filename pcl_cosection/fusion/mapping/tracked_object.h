// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/tracking/brightness_tracking.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <map>
#include <optional>

namespace pcl::cosection {

/** \brief What an object is, by all detections of it.
 *
 * A detection tells the score of one class; those of all others are taken for 0. The score of a class is the mean over
 * all detections. Fusion++ averages class probabilities so, instead of multiplying them as SemanticFusion does:
 * detections from similar views are not independent, and their product soon is certain of what is wrong. J. McCormac et
 * al., "Fusion++: Volumetric Object-Level SLAM", 3DV 2018; J. McCormac et al., "SemanticFusion: Dense 3D Semantic
 * Mapping with Convolutional Neural Networks", ICRA 2017. */
class ClassEvidence
{
public:
  /** \brief Count a detection. \throws InvalidArgument if its score is not in [0, 1] */
  void add (const ClassScore& detection);

  /** \brief Count all detections of something else that turns out to be the same object. */
  void add (const ClassEvidence& other);

  /** \brief How many there were. */
  std::size_t detections () const { return detections_; }

  /** \brief The class of the highest score, of equals that of the smallest class_id, with its score; nothing without a
   * detection. The name is the one that came first with the class_id. */
  std::optional<ClassScore> best () const;

private:
  std::map<int, ClassScore> sums_; // over detections, by class_id
  std::size_t detections_ = 0;
};

enum class ObjectState
{
  Tracked, ///< its pose is known in this frame
  Hidden,  ///< out of view or occluded
  Lost,    ///< it should be in view, but is not found
  Dormant, ///< not seen for long; it is looked for only in masks
  Retired, ///< dormant for long: only its surface is kept
};

/** \brief All that is known of one object. */
struct TrackedObject
{
  TrackedObject (int id, const VoxelGrid& grid, const TsdfOptions& tsdf, const Eigen::Isometry3d& T_world_object)
      : id (id)
      , volume (TsdfVolume (grid, tsdf))
      , T_world_object (T_world_object)
      , first_place (T_world_object.translation ())
      , T_world_rest (T_world_object)
  {}

  /** \brief Take over a pose that tracking found. */
  void moveTo (const Eigen::Isometry3d& T_world);

  bool isTracked () const { return state == ObjectState::Tracked; }

  /** \brief Whether it is looked for in every frame. */
  bool isActive () const { return state < ObjectState::Dormant; }

  /** \brief Whether it has not been seen to move lately. */
  bool rests () const { return isTracked () && frames_at_rest >= frames_of_rest; }

  /** \brief Share of the masks in which it should have been seen and was. */
  double existence () const { return seen + missed > 0 ? static_cast<double> (seen) / (seen + missed) : 1.0; }

  /** \brief Its pose in the next frame if it moves on as before. */
  Eigen::Isometry3d predicted () const
  {
    return isTracked () ? Eigen::Isometry3d (last_motion * T_world_object) : T_world_object;
  }

  /** \brief Whether it is certainly not at its first place. */
  bool hasMoved () const
  {
    return (T_world_object.translation () - first_place).norm () > certain_voxels * volume->grid ().voxel_size_m;
  }

  static constexpr double certain_voxels = 4.0; ///< of its volume: twice the largest error of its pose
  static constexpr int frames_of_rest = 10;     ///< after which an object that moved is believed to rest
  static constexpr int frames_of_motion = 3;    ///< away from its place, that are no error of the camera's pose

  int id;
  ObjectState state = ObjectState::Tracked;
  bool confirmed = true; ///< else only one unreliable mask has shown it: it is tracked, but not reported

  std::optional<TsdfVolume> volume; ///< object frame; nothing once it is retired
  TriangleMesh surface;             ///< object frame; only once it is retired
  BrightnessReference brightness;   ///< of its surface
  bool reached_max_size = false;    ///< its volume cannot grow any more
  ClassEvidence classes;            ///< by masks whose instances have classes

  Eigen::Isometry3d T_world_object;                               ///< the last accepted one
  Eigen::Isometry3d last_motion = Eigen::Isometry3d::Identity (); ///< T_now_before, world frame
  Eigen::Vector3d first_place;                                    ///< world frame
  Eigen::Isometry3d T_world_rest;                                 ///< its pose since it rests, within noise
  int frames_at_rest = frames_of_rest;                            ///< a new object rests until it is seen to move
  int frames_away = 0;                                            ///< in a row, from T_world_rest
  int frames_not_tracked = 0;                                     ///< in a row
  int dormant_since = 0;                                          ///< ascending number, from 1
  double range_m = 0.0;                                           ///< mean depth when it was first seen

  int mask_id = 0; ///< its number in the masks, if numbers persist
  int seen = 0;    ///< in masks
  int missed = 0;  ///< masks in which it should have been seen
  int unshown = 0; ///< masks that did not show it while it was not confirmed
};

} // namespace pcl::cosection
