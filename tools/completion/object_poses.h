// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

/** \brief Where moving objects were in each view. */
class ObjectPoses
{
public:
  /** \param[in] files trajectories whose stamps are views, by label \param[in] views how many there are
   * \throws pcl::cosection::IoError */
  ObjectPoses (const std::map<int, std::string>& files, std::size_t views);

  bool empty () const { return (T_world_object_.empty ()); }

  /** \brief One pose per view, not finite where the trajectory has none; empty for an object that rests. */
  const std::vector<Eigen::Isometry3d>& of (int label) const;

  /** \brief Warnings about trajectories of other labels than the given ones. */
  std::vector<std::string> unused (const std::vector<int>& labels) const;

private:
  std::map<int, std::string> files_;
  std::map<int, std::vector<Eigen::Isometry3d>> T_world_object_;
};
