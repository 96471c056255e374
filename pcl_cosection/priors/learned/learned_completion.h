// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief An object as a network completes it. */
struct LearnedCompletion
{
  SignedDistanceField field; ///< metres, in a cube: small where the network is not sure
  Eigen::Isometry3d T_cube_object;
  TriangleMesh mesh; ///< its zero set, in the object's frame; empty if nothing is expected
};

/** \brief Complete an object by a network.
 * \param[in] points of the object
 * \param[in] views of it, and their sensors' poses in its frame
 * \param[in] plane n.x + d = 0 on which it stands, unit n towards it
 * \param[in] is_cut_out what is around it was removed: rays without a reading beside it are free */
LearnedCompletion completedByNetwork (const CompletionNetwork& network, const std::vector<OrientedPoint>& points,
                                      const SensorViews& views, const Eigen::Vector4d& plane, bool is_cut_out);

/** \brief What other priors expect, corrected where the network is sure: both are observers of each place, whose log
 * odds that there is matter are added.
 * \param[in] expected signed distance, metres, in the object's frame
 * \return about the distance near its zero set */
SignedDistanceField correctedDistance (const LearnedCompletion& learned, SignedDistanceField expected, int threads);

} // namespace pcl::cosection
