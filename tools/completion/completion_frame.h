// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"
#include "scene_input.h"

#include <pcl/cosection/surface/co_section.h>

#include <Eigen/Geometry>

/** \brief From the frame in which a scene is completed to that of its input: voxels lie along the axes of the first
 * sensor. So a view gives the same meshes, turned, whatever the rotation of its VIEWPOINT. */
Eigen::Quaterniond completionFrame (const SceneInput& scene);

/** \brief Take what is in the world frame to a turned one. */
void turnInput (const Eigen::Quaterniond& R_frame_world, SceneInput& scene);

/** \brief Take what is in a turned frame to the world's. Signed distances, whose voxels lie along the axes of their
 * frame, are sampled anew. Objects with trajectories, which are in frames of their own, stay; pieces of the background,
 * which no program shows, are left out. */
void turnResult (const Eigen::Quaterniond& R_world_frame, const Settings& settings,
                 pcl::cosection::SceneResult& result);
