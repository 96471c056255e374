// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "principal_axes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace pcl::cosection {

Scatter
scatterOf (const std::vector<OrientedPoint>& points)
{
  // One pass, relative to a point near the mean, so that no digits are lost.
  const Eigen::Vector3d about = points.empty () ? Eigen::Vector3d::Zero ()
                                                : points.front ().position.cast<double> ().eval ();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero ();
  Eigen::Vector3d mixed = Eigen::Vector3d::Zero (); // yz, xz, xy
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d d = p.position.cast<double> () - about;
    sum += d;
    squares += d.cwiseProduct (d);
    mixed += Eigen::Vector3d (d.y () * d.z (), d.x () * d.z (), d.x () * d.y ());
  }
  Scatter scatter;
  scatter.products << squares.x (), mixed.z (), mixed.y (), mixed.z (), squares.y (), mixed.x (), mixed.y (),
      mixed.x (), squares.z ();
  const Eigen::Vector3d offset = sum / static_cast<double> (points.size ());
  scatter.products -= offset * sum.transpose ();
  scatter.mean = about + offset;
  return scatter;
}

Eigen::Matrix3d
principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up)
{
  Eigen::Matrix3d covariance = scatterOf (points).products;
  if (up)
  {
    const Eigen::Matrix3d flatten = Eigen::Matrix3d::Identity () - *up * up->transpose ();
    covariance = flatten * covariance * flatten;
  }
  Eigen::Vector3d longest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (covariance).eigenvectors ().col (2);
  const Eigen::Vector3d
      vertical = up ? *up : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (covariance).eigenvectors ().col (0);
  longest = (longest - vertical.dot (longest) * vertical).normalized ();
  if (!(longest.norm () > 0.5)) // all points lie on one line along up
    longest = vertical.unitOrthogonal ();
  Eigen::Matrix3d axes;
  axes << longest, vertical.cross (longest), vertical;
  return axes;
}

} // namespace pcl::cosection
