// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief The height of the lowest vertex over a plane n.x + d = 0, unit n. */
double lowestOver (const Eigen::Vector4d& plane, const TriangleMesh& mesh);

/** \brief Whether things can stand on a plane n.x + d = 0: others are walls. \param[in] up unit */
inline bool
isLevel (const Eigen::Vector4d& plane, const Eigen::Vector3d& up)
{
  constexpr double level = 0.9; // cosine
  return plane.head<3> ().dot (up) > level;
}

/** \brief A mesh whose vertices between a plane and \a band_m over it, or behind it, lie on it: the bottom of a thing
 * that stands there is flat, as that of what it shows is, however the estimate's voxels have rounded its edges. */
TriangleMesh flattenedOn (const Eigen::Vector4d& plane, TriangleMesh mesh, double band_m);

/** \brief Whether a body stands, by where it touches the ground. */
struct Stance
{
  bool stands = false;               ///< its centre of mass is over the contact polygon, or was moved there
  double shift_m = 0.0;              ///< how far it was moved
  Eigen::Vector3d centre;            ///< of mass
  std::vector<Eigen::Vector3d> feet; ///< corners of the contact polygon, at most eight, which hold most of its area
};

/** \brief Move a centre of mass sideways, as little as is needed, over the convex hull of the points where a body
 * touches a plane: a thing that was seen standing stands, so that the estimate of its mass is off.
 * \param[in] points corners of the parts it collides by \param[in] plane n.x + d = 0, unit n upwards
 * \param[in] tolerance_m what is so near to the plane touches it */
Stance stanceOf (const std::vector<Eigen::Vector3d>& points, const Eigen::Vector4d& plane,
                 const Eigen::Vector3d& centre_m, double tolerance_m);

} // namespace pcl::cosection
