// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/motion_segmentation.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief A frame of a scene with moving objects, and the truth. */
struct MovingView
{
  MotionFrame frame;
  std::vector<std::uint32_t> labels;
  std::vector<char> valid;
  std::vector<float> room_depth; ///< without the objects
};

/** \brief Objects that move on a table in front of a wall, seen by a noisy camera of 320 x 240 pixels. */
class MovingTable
{
public:
  /** \param[in] objects contents of "objects" of a scene's description
   * \param[in] camera_keys contents of the camera's "keys"; empty: it rests */
  explicit MovingTable (const std::string& objects, const std::string& camera_keys = "");

  /** \brief Frame n, at n thirtieths of a second. */
  MovingView at (int n) const;

private:
  SimulatedScene scene_;
  SimulatedScene room_;
};

/** \brief A box of a scene's description. \param[in] keys of its motion */
std::string movingBox (int id, const Eigen::Vector3d& size, const std::string& keys);

} // namespace pcl::cosection::test
