// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"
#include "object_poses.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/surface/co_section.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

/** \brief What all input files together say. */
struct SceneInput
{
  std::map<int, pcl::cosection::ObjectInput> objects; ///< by label
  std::vector<pcl::cosection::OrientedPoint> background;
  std::vector<pcl::cosection::DepthView> views;        ///< of the INPUTs
  std::vector<std::size_t> view_inputs;                ///< of each view, the number of its INPUT, from 0
  std::vector<pcl::cosection::DepthView> free_space;   ///< further views, of which nothing else is used
  std::vector<pcl::cosection::TriangleMesh> obstacles; ///< world frame
  std::vector<Eigen::Vector4d> planes;                 ///< that are given, and near objects
  Eigen::Vector3d origin = Eigen::Vector3d::Zero ();   ///< of the frame of all this, in the world
  std::vector<std::string> warnings;
};

/** \brief A plane of the world in a frame with another origin. */
Eigen::Vector4d relativeTo (const Eigen::Vector3d& origin, const Eigen::Vector4d& plane);

/** \brief Take points to another frame, with their normals. */
void transform (const Eigen::Isometry3d& T_target_points, std::vector<pcl::cosection::OrientedPoint>& points);

/** \brief Where what the settings name comes from. */
struct SceneReaders
{
  std::function<pcl::cosection::LabelledView (const std::string& name, const pcl::cosection::PcdViewOptions& options)>
      view;
  std::function<pcl::cosection::TriangleMesh (const std::string& name, const Eigen::Vector3d& origin)> obstacle;
  std::function<pcl::cosection::TriangleMesh (const std::string& name)> proposal;
  std::function<ObjectPoses (const std::map<int, std::string>& names, std::size_t views)> poses;

  static SceneReaders ofFiles ();
};

/** \brief Read and merge the views; labels of too few points are dropped with a warning.
 * \throws pcl::cosection::Error also if no object is left, or if \a progress returns false */
SceneInput readScene (const Settings& settings, const pcl::cosection::ProgressCallback& progress,
                      const SceneReaders& readers = SceneReaders::ofFiles ());
