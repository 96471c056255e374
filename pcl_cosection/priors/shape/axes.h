// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Mean of positions, and their scatter matrix, the sum of (p - mean) (p - mean)^T. */
struct Scatter
{
  Eigen::Vector3d mean;
  Eigen::Matrix3d products;
};

Scatter scatterOf (const std::vector<OrientedPoint>& points);

/** \brief Principal axes of points as columns, independent of the points' frame; their senses are arbitrary. The last
 * axis is \a up, if given, otherwise the direction of least extent; the first one, orthogonal to it, is that of the
 * largest extent. */
Eigen::Matrix3d principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up);

/** \brief Principal axes, each with the sense in which the points are skewed along it, but for \a up. */
Eigen::Matrix3d orientedAxes (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& up);

/** \brief The line of a point's normal, in Pluecker coordinates (normal, moment). */
struct NormalLine
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal; // unit
  Eigen::Vector3d moment; // position x normal
};

/** \brief The normals of points as lines. Positions are relative to the mean of all points, in units of their size:
 * twice the root mean square distance from the mean. */
struct NormalLines
{
  std::vector<NormalLine> lines;
  Eigen::Vector3d origin; // of the lines' frame, in the points' frame
  double size;            // metres; 0 if all points coincide
};

NormalLines normalLinesOf (const std::vector<OrientedPoint>& points);

struct Axis
{
  Eigen::Vector3d direction; // unit
  Eigen::Vector3d point;
};

/** \brief Whether a normal meets an axis within noise. */
bool meets (const Axis& axis, const NormalLine& line);

/** \brief Whether the angle between a normal and an axis is large enough for the normal to determine the axis. */
bool facesSideways (const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

/** \brief The axis that most normals meet.
 *
 * All normals of a surface of revolution meet its axis (H. Pottmann, T. Randrup: Rotational and helical surface
 * approximation for reverse engineering, Computing 60, 1998): with the axis' direction d and moment m = a x d, d.(p x
 * n) + m.n = 0 for each point p with normal n. Reweighted least squares, started from the three orthogonal axes that
 * are best without weights.
 * \param[in] up a direction that is preferred if nearly as many normals meet an axis along it
 * \return nothing if few normals face sideways, or less than three quarters of those meet an axis */
std::optional<Axis> findAxis (const std::vector<NormalLine>& lines, const std::optional<Eigen::Vector3d>& up);

/** \brief Refine the position of an axis of revolution by the positions of points, which are more precise than the
 * normals that found it.
 *
 * Least squares of the points' distances from their profile, which is straight in each of some bands of height, with
 * one line for the outer and one for the inner side. Gauss-Newton with Cauchy weights, as protruding parts do not
 * belong to the profile. The direction is kept: for a ring, with its curved profile, normals determine it better. */
Axis refineAxis (const Axis& axis, const std::vector<NormalLine>& lines);

} // namespace pcl::cosection
