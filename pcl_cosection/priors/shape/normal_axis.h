// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief A normal as a line. */
struct NormalLine
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal; // unit
  Eigen::Vector3d moment; // position x normal
};

/** \brief The normals of points as lines; lengths are from the mean of all points and in units of their size, twice the
 * root mean square of their distances from it. */
struct NormalLines
{
  std::vector<NormalLine> lines;
  Eigen::Vector3d origin; // of their frame, that of the points
  double size;            // metres; 0 if all points are one
};

NormalLines normalLinesOf (const std::vector<OrientedPoint>& points);

struct Axis
{
  Eigen::Vector3d direction; // unit
  Eigen::Vector3d point;
};

/** \brief Does a normal meet an axis, but for noise? */
bool meets (const Axis& axis, const NormalLine& line);

/** \brief Is a normal so far from the direction of an axis that it tells of what is round about it? */
bool facesSideways (const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

/** \brief The axis that most normals meet.
 *
 * All normals of a surface of revolution meet its axis (H. Pottmann, T. Randrup: Rotational and helical surface
 * approximation for reverse engineering, Computing 60, 1998): with the axis' direction d and moment m = a x d, d.(p x
 * n) + m.n = 0 for each point p with normal n. Reweighted least squares, begun at the three axes across each other that
 * are best without weights.
 * \param[in] up a direction that is preferred if nearly as many normals meet an axis along it
 * \return nothing if less than three quarters of the normals that face sideways meet any, or if few face sideways */
std::optional<Axis> findAxis (const std::vector<NormalLine>& lines, const std::optional<Eigen::Vector3d>& up);

} // namespace pcl::cosection
