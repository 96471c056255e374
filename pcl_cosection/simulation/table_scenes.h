// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Random scenes of given things on a table, and how a depth camera sees them. */
struct TableSceneOptions
{
  int scenes = 0;                  // 0: as many as show each thing once
  int per_scene = 1;               // things; one alone stands in the middle
  int views = 1;                   // from places around the table, at equal angles
  std::uint64_t seed = 1;          // of places, turns, order and noise
  double camera_height_m = 0.45;   // above the table
  double camera_distance_m = 0.75; // from the middle of the table, along it; 0: straight above
  bool noise = true;               // of a structured-light camera
  int mask_dilation_px = 0;        // labels grow by so many pixels; negative: they shrink
  int mask_shift_px = 0;           // labels are so many pixels too far to the right
  int occluders = 0;               // posts without a label between the first camera and the things

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Things on a table, world frame: z upwards, the top of the table is z = 0. */
struct TableScene
{
  std::vector<std::string> names;
  std::vector<TriangleMesh> things;       // thing n has label n + 1
  TriangleMesh room;                      // table, floor, wall and posts: label 0
  std::vector<Eigen::Isometry3d> cameras; // T_world_sensor of each view
};

/** \brief Put things on a table. Each of them stands as its mesh has it, z upwards, turned about z by a random angle;
 * the circles around them do not touch. Scenes take them in one random order, each once before any twice; alone, in
 * their own order.
 * \throws InvalidArgument if there is no room for so many */
TableScene makeTableScene (const std::vector<std::string>& names, const std::vector<TriangleMesh>& meshes, int scene,
                           const TableSceneOptions& options);

/** \brief Labels as a segmentation with errors would give them: labels grow over the background beside them, or their
 * borders become background; then all move to the right.
 * \param[in] labels 0: background
 * \param[in] dilation_px negative: they shrink
 * \param[in] shift_px negative: to the left */
PCL_COSECTION_EXPORT Image<std::uint16_t> withMaskErrors (Image<std::uint16_t> labels, int dilation_px, int shift_px);

/** \brief Write the scenes of all PLY, OBJ, STL, OFF, VTK and VTP files of a folder into a new one:
 *
 *     SCENE/viewN.pcd         organised, 640 x 480, fields x y z rgba label, VIEWPOINT = pose of the sensor
 *     SCENE/truth_LABEL.ply   the thing, world frame
 *     SCENE/names.txt         LABEL NAME of each thing
 *
 * Nothing is left if it fails.
 * \param[out] warnings a line for each view that has no reading of a thing, and for meshes that are open or tiny
 * \return number of scenes
 * \throws IoError if there are no meshes, the output exists or cannot be written; Cancelled; InvalidArgument */
int writeTableScenes (const std::string& meshes, const std::string& output, const TableSceneOptions& options,
                      std::vector<std::string>& warnings, const ProgressCallback& progress = {});

} // namespace pcl::cosection
