// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "principal_axes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace pcl
{
namespace cosection
{

Eigen::Matrix3d
principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  for (const OrientedPoint& p : points)
    mean += p.position.cast<double> () / static_cast<double> (points.size ());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero ();
  for (const OrientedPoint& p : points)
  {
    Eigen::Vector3d d = p.position.cast<double> () - mean;
    if (up)
      d -= up->dot (d) * *up;
    covariance += d * d.transpose ();
  }
  Eigen::Vector3d longest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (covariance).eigenvectors ().col (2);
  const Eigen::Vector3d upright = up ? *up : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (covariance).eigenvectors ().col (0);
  longest = (longest - upright.dot (longest) * upright).normalized ();
  if (!longest.allFinite ())
    longest = upright.unitOrthogonal ();
  Eigen::Matrix3d axes;
  axes << longest, upright.cross (longest), upright;
  return axes;
}

} // namespace cosection
} // namespace pcl
