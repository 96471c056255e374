// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pcl::cosection {

/** \brief Remembers where frames have shown things that are too long to be objects. One view shows less of a cupboard
 * than another one: a thing that was too long in most frames is no object, though a part of it could be one. */
class ObjectSizeFilter
{
public:
  void clear () { counts_.clear (); }

  /** \brief Remember the segmentation of a frame, and remove objects from it that were too long in more frames than
   * not.
   * \param[in] points sensor frame, metres */
  void filter (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_camera,
               ObjectSegmentation& found);

private:
  struct Frames
  {
    int too_long = 0; ///< in which a thing there was too long
    int object = 0;   ///< in which it was an object
    int counted = 0;  ///< number of the last one: each counts once
  };

  std::unordered_map<std::uint64_t, Frames> counts_; ///< by voxel of the world
  int frame_ = 0;
};

} // namespace pcl::cosection
