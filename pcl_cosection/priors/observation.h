// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "occlusion_map.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <functional>
#include <memory>
#include <vector>

namespace pcl::cosection {

class ShapeFits;

/** \brief The measurements of one object, in its frame, metres. */
struct Observation
{
  const std::vector<OrientedPoint>* all_points = nullptr; // as the user gave them
  std::vector<OrientedPoint> inliers;                     // without outliers; empty if there are no outliers
  Eigen::AlignedBox3d box;                                // of the points
  double spacing_m = 0.0;                                 // supportedVoxelSize () of the points
  double voxel_size_m = 0.0;                              // of the object's grid; vessels may have a finer one
  Eigen::Vector3d extents_m = Eigen::Vector3d::Zero ();   // observedExtents () of the points
  std::shared_ptr<const DepthView> virtual_view;          // from a virtual viewpoint, if there are no views; else null
  OcclusionMap::Views views;                              // views with a known pose of the object, or the virtual view
  std::shared_ptr<ShapeFits> fits;                        // shapes that were fitted to the points so far

  const std::vector<OrientedPoint>& points () const { return inliers.empty () ? *all_points : inliers; }

  std::size_t outliers () const { return inliers.empty () ? 0 : all_points->size () - inliers.size (); }
};

/** \brief The surroundings of an object, as priors need them. */
struct ObjectSetting
{
  bool is_alone = false;                                              // no plane, background or obstacle is known
  const std::vector<OrientedPoint>& background;                       // world frame; empty: the object was cut out
  Eigen::Isometry3d T_object_world = Eigen::Isometry3d::Identity ();  // in its first view
  const OcclusionMap& hidden;                                         // occlusion of the object's volume by its views
  std::function<bool (const Eigen::Vector3d&)> is_of_other = nullptr; // may another object be there? object frame
};

} // namespace pcl::cosection
