// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/brightness_tracking.h"

#include "pcl_cosection/fusion/mapping/class_evidence.h"
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection
{

enum class ObjectState
{
  Tracked,
  Hidden, ///< out of view, or behind something else
  Lost,   ///< it should be seen, but is not found
};

/** \brief An object that is tracked: its volume and what is known of its motion. */
struct TrackedObject
{
  TrackedObject (int id, const VoxelGrid& grid, const TsdfOptions& tsdf, const Eigen::Isometry3d& T_world_object)
      : id (id)
      , volume (grid, tsdf)
      , T_world_object (T_world_object)
      , first_place (T_world_object.translation ())
      , T_world_rest (T_world_object)
  {}

  /** \brief It was tracked to here. */
  void moveTo (const Eigen::Isometry3d& T_world);

  /** \brief Whether it has not been seen to move of late. */
  bool rests () const { return state == ObjectState::Tracked && frames_at_rest >= frames_of_rest; }

  /** \brief Share of the masks in which it should have been seen and was. */
  double existence () const { return seen + missed > 0 ? static_cast<double> (seen) / (seen + missed) : 1.0; }

  /** \brief Where it is next, if it goes on as it did. */
  Eigen::Isometry3d predicted () const
  {
    return state == ObjectState::Tracked ? last_motion * T_world_object : T_world_object;
  }

  /** \brief Whether it is not where it began, for certain. */
  bool hasMoved () const
  {
    return (T_world_object.translation () - first_place).norm () > certain_voxels * volume.grid ().voxel_size_m;
  }

  static constexpr double certain_voxels = 4.0; ///< of its volume: twice as far as its pose may be wrong
  static constexpr int frames_of_rest = 10;     ///< after which what moved is believed to rest
  static constexpr int
      frames_of_motion = 3; ///< after which what is elsewhere is believed to have moved: the camera may have erred

  int id;
  TsdfVolume volume;                                              ///< object frame
  BrightnessTracking brightness;                                  ///< of its surface
  Eigen::Isometry3d T_world_object;                               ///< the last good one
  Eigen::Vector3d first_place;                                    ///< world frame
  Eigen::Isometry3d last_motion = Eigen::Isometry3d::Identity (); ///< T_now_before, world frame
  Eigen::Isometry3d T_world_rest;                                 ///< where it has been since, within noise
  int frames_away = 0;                                            ///< from there, in a row
  int frames_at_rest = frames_of_rest;                            ///< a new object rests until it is seen to move
  ObjectState state = ObjectState::Tracked;
  bool confirmed = true; ///< else one mask showed it that may be wrong: it is tracked, and told to nobody
  int unshown = 0;       ///< masks since then that did not
  int mask_id = 0;       ///< in the masks, if ids persist
  int seen = 0;          ///< in masks
  int missed = 0;
  ClassEvidence classes;      ///< by what masks showed of it, where that is of known class
  int frames_not_tracked = 0; ///< since it was
  std::size_t pixels = 0;     ///< assigned to it when it was last tracked
  double range_m = 0.0;       ///< mean depth of those
};

/** \brief Where the volume of a new object lies: centred on the box of its points without a tenth of them at either end
 * of each axis, its edge twice the longest side of that. Nothing for too few points or none of extent.
 * \param[in] points world frame */
std::optional<VoxelGrid> placeObjectVolume (const std::vector<Eigen::Vector3f>& points, int resolution);

/** \brief Make room for points that have come near the volume's sides or beyond; its voxels stay.
 * \param[in] points object frame
 * \return whether the volume holds them, but for outliers */
bool growObjectVolume (TsdfVolume& volume, const std::vector<Eigen::Vector3f>& points, int max_resolution);

/** \brief Intersection over union of two volumes' boxes, by sampling the first. */
double volumeOverlap (const VoxelGrid& a, const Eigen::Isometry3d& T_world_a, const VoxelGrid& b,
                      const Eigen::Isometry3d& T_world_b);

} // namespace pcl::cosection
