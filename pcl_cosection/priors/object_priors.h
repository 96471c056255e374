// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "occlusion_map.h"
#include "pcl_cosection/energy/body_energy.h"
#include "pcl_cosection/priors/shape/profiled_shape.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Geometry>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The shapes with a profile fitted to one object's points by support plane, each once; zeros: without a plane.
 */
using ShapeFits = std::map<std::array<double, 4>, ProfiledShape>;

struct ProposedShapes; // proposed/proposed_shape.h

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
  OcclusionMap hidden;                                    // occlusion of its volume by these views
  std::shared_ptr<ShapeFits> fits;                        // shapes that were fitted to the points so far
  const std::vector<TriangleMesh>* proposals = nullptr;   // meshes that may be its shape
  std::shared_ptr<ProposedShapes> proposed;               // the best of them, once it is aligned
  CompletionNetwork::ConstPtr network;                    // of the learned prior, or null

  const std::vector<OrientedPoint>& points () const { return inliers.empty () ? *all_points : inliers; }

  std::size_t outliers () const { return inliers.empty () ? 0 : all_points->size () - inliers.size (); }
};

/** \brief The surroundings of an object, as priors need them. */
struct ObjectSetting
{
  bool is_alone = false;                                             // no plane, background or obstacle is known
  const std::vector<OrientedPoint>& background;                      // world frame; empty: the object was cut out
  Eigen::Isometry3d T_object_world = Eigen::Isometry3d::Identity (); // in its first view
  Priors priors = {};                                                // which ones are on
  int threads = 0;                                                   // 0: all
  // Whether a place may belong to another object: it is in a box of that one's points. \param[in] up of the box
  std::function<bool (const Eigen::Vector3d& place, const Eigen::Vector3d& up)> is_of_other = nullptr; // object frame
  std::vector<OrientedPoint> under_others = {}; // surface on which other objects stand that hide it; object frame
};

// The priors of an object: what is expected where nothing was measured and no constraint decides. All effects of priors
// on a completion go through these four functions and levelTopBelow (). Planes are n.x + d = 0, unit n towards the
// object, in its frame.

/** \brief The wall thickness of an object that is hollow and open, metres; 0 for other shapes.
 * \param[in] planes on which it may stand */
double wallThickness (const Observation& object, const ObjectSetting& setting,
                      const std::vector<Eigen::Vector4d>& planes);

/** \brief The support plane that the points of an object without known surroundings suggest; nothing if they suggest no
 * plane. */
std::optional<Eigen::Vector4d> inferSupportPlane (const Observation& object, const ObjectSetting& setting);

/** \brief Box of the points and, where something else hides them, of their projections onto the planes. */
Eigen::AlignedBox3d boxDownToPlanes (const Observation& object, const ObjectSetting& setting,
                                     const std::vector<Eigen::Vector4d>& planes);

/** \brief Add the terms of all priors that the options enable to an object's energy.
 * \param[in] planes on which it may stand
 * \param[in,out] energy with data term and free space */
void addPriors (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
                BodyEnergy& energy);

} // namespace pcl::cosection
