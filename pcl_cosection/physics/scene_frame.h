// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/scene_builder.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pcl::cosection {

constexpr double standard_gravity = 9.80665; // m/s^2

/** \brief Where a scene's frame is, and what is up in it. */
struct FrameOfScene
{
  Eigen::Isometry3d T_world_scene = Eigen::Isometry3d::Identity ();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ (); ///< unit
};

/** \brief Up is the normal of the plane that most objects stand on; without planes it is z. */
FrameOfScene frameOfScene (const CompletedScene& scene, SceneFrame frame);

} // namespace pcl::cosection
