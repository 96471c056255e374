// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_map.h"

#include <pcl/cosection/io/rgbd_sequence.h>

#include <optional>

namespace pcl::cosection {

// Where the volumes of the background and of objects lie, and what a frame adds to them.

/** \brief Place the volume of the background, world frame, around the points of the first frame; in later ones, shift
 * it to the points in view: what is far behind the camera is forgotten. A frame with hardly any point changes nothing.
 */
void followBackground (const PosedFrame& frame, const FusionSetup& setup, std::optional<TsdfVolume>& background);

/** \brief Place the volume of a new object, world frame: centred on the box of its points without a tenth of them at
 * either end of each axis, with an edge twice the longest side of the box. Nothing for too few points or points without
 * extent. \param[in] points sensor frame */
std::optional<VoxelGrid> placeObjectVolume (const std::vector<Eigen::Vector3f>& points,
                                            const Eigen::Isometry3d& T_world_sensor, int resolution);

/** \brief Intersection over union of the boxes of a volume in the world frame and an object's, by sampling the first.
 */
double volumeOverlap (const VoxelGrid& a, const VoxelGrid& b, const Eigen::Isometry3d& T_world_b);

/** \brief Grow the volumes of tracked objects so that they hold the points of their labels. */
void growVolumes (const PosedFrame& frame, const LabelImage& labels, int max_resolution, ObjectMap& objects,
                  EventLog& log);

/** \brief Count the pixels of objects that have absorbed others as their foreground: masks before counted the absorbed
 * parts against them. \param[in] whole_of labels by label of an absorbed part */
void countAbsorbed (const PosedFrame& frame, const LabelImage& labels, const LabelMap& whole_of, ObjectMap& objects);

/** \brief Integrate the depth of a frame into the volumes of the background and of tracked objects, and free space into
 * those of the objects; with a mask, count the foreground of all: TsdfVolume.
 * \param[in] images of the frame \param[in] masked a mask has part in the labels */
void integrateFrame (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels, bool masked,
                     TsdfVolume& background, ObjectMap& objects);

} // namespace pcl::cosection
