// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pcl::cosection
{

/** \brief Where frames have shown things that are too long for objects. A view of one of its faces shows less of a
 * cupboard than another view did: what most frames have seen to be too long is none, though a part of it would be one
 * by itself. */
class ObjectSizeFilter
{
public:
  void clear () { counts_.clear (); }

  /** \brief Remember what a frame shows, and take out of it the objects that more frames have seen to be too long than
   * not.
   * \param[in] points sensor frame, metres */
  void judge (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_camera,
              ObjectSegmentation& found);

private:
  struct Frames
  {
    int too_long = 0; ///< that showed it to be so there
    int object = 0;   ///< an object
    int counted = 0;  ///< the last one, in which it counts once
  };

  std::unordered_map<std::uint64_t, Frames> counts_; ///< by voxel of the world
  int frame_ = 0;
};

} // namespace pcl::cosection
