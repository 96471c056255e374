// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_priors.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <vector>

namespace pcl::cosection {

// What no prior can know of an object: a user is warned of it.

/** \brief Share of an object's outline beside which something else is nearer, in the view where it is least, or the
 * first one where it is at most \a enough; 0 without views.
 * \param[in] is_cut_out what is around it was removed
 * \param[in] planes that bound the object, n.x + d = 0, unit n towards it: what is at one, before the object, hides
 * nothing of it \param[in] completed surface, near which what is nearer is the object's own */
double hiddenOutline (const Observation& object, bool is_cut_out, const std::vector<Eigen::Vector4d>& planes,
                      const SignedDistanceField& completed, double enough);

/** \brief How far a mesh reaches behind the only side of it that was seen, which is flat, metres.
 * \param[in] planes at which it may end, n.x + d = 0
 * \return 0 if more than that was seen, or the mesh ends at a plane or another body there */
double depthBehindOnlySide (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector4d>& planes,
                            double voxel_size_m, const TriangleMesh& mesh);

/** \brief How far a mesh reaches below all points of its object, down to a plane, metres; 0 if that is less than all
 * that was seen of it is long, as where the foot of a thing is hidden.
 * \param[in] planes at which it may end, n.x + d = 0, unit n towards it */
double depthDownToPlane (const Observation& object, const std::vector<Eigen::Vector4d>& planes,
                         const TriangleMesh& mesh);

} // namespace pcl::cosection
