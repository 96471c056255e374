// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

/** \brief T_world_object of each view by label, not finite where the trajectory has none. */
using ObjectPoses = std::map<int, std::vector<Eigen::Isometry3d>>;

/** \brief Read trajectories whose stamps are the numbers of views.
 * \param[in] files by label \param[in] views how many there are
 * \throws IoError if a file cannot be read or has no pose for any of the views */
ObjectPoses readPoses (const std::map<int, std::string>& files, std::size_t views);

/** \brief The poses in a world whose origin is moved to a place. */
ObjectPoses relativeTo (const Eigen::Vector3d& origin, ObjectPoses poses);

/** \brief The pose of the file that each view is of: a sensor that sees all around gives several views.
 * \param[in] inputs number of the file of each view */
ObjectPoses ofInputs (const std::vector<std::size_t>& inputs, const ObjectPoses& poses);

/** \brief Those of one label; empty for an object that rests. */
std::vector<Eigen::Isometry3d> posesOf (const ObjectPoses& poses, std::uint32_t label);
