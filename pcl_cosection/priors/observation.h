// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "occlusion_map.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <functional>
#include <memory>
#include <vector>

namespace pcl::cosection
{

class ShapeFits;

/** \brief What was measured of one object, in its frame, metres. */
struct Observation
{
  const std::vector<OrientedPoint>* all_points = nullptr; // as the user gave them
  std::vector<OrientedPoint> inliers;                     // without outliers, if there are some; else empty
  Eigen::AlignedBox3d box;                                // of the points
  double spacing_m = 0.0;                                 // supportedVoxelSize () of the points
  double voxel_size_m = 0.0;                              // of the object's grid; vessels may have a finer one
  Eigen::Vector3d extents_m = Eigen::Vector3d::Zero ();   // observedExtents () of the points
  std::shared_ptr<const DepthView> virtual_view;          // of the points, if no view saw the object; else null
  OcclusionMap::Views views;       // which saw where the object is or may be; or the virtual view
  std::shared_ptr<ShapeFits> fits; // shapes that were fitted to the points so far

  const std::vector<OrientedPoint>& points () const { return inliers.empty () ? *all_points : inliers; }

  std::size_t outliers () const { return inliers.empty () ? 0 : all_points->size () - inliers.size (); }
};

/** \brief What surrounds an object, as far as priors ask for it. */
struct ObjectSetting
{
  bool is_alone = false;                        // neither a plane nor a background nor a given body is known
  const std::vector<OrientedPoint>& background; // world frame; empty: the object was cut out
  Eigen::Isometry3d T_object_world = Eigen::Isometry3d::Identity ();  // when it was first seen
  const OcclusionMap& hidden;                                         // what the views hide of the object
  std::function<bool (const Eigen::Vector3d&)> is_of_other = nullptr; // may a place be another object's? object frame
};

} // namespace pcl::cosection
