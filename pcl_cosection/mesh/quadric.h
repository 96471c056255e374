// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace pcl::cosection {

/** \brief Weighted sum of squared distances to planes as a function of position,
 * Q (x) = x^T A x + 2 b^T x + c (Garland and Heckbert 1997). */
class Quadric
{
public:
  /** \brief Add the plane through \a point with unit normal \a normal. */
  void addPlane (const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight)
  {
    const double d = -normal.dot (point);
    A_ += weight * normal * normal.transpose ();
    b_ += weight * d * normal;
    c_ += weight * d * d;
  }

  Quadric& operator+= (const Quadric& other)
  {
    A_ += other.A_;
    b_ += other.b_;
    c_ += other.c_;
    return *this;
  }

  double operator() (const Eigen::Vector3d& x) const { return x.dot (A_ * x + 2.0 * b_) + c_; }

  /** \brief Sum of the planes' weights. */
  double weight () const { return A_.trace (); }

  /** \brief The minimum near \a start: along directions in which Q hardly changes the result stays there.
   *
   * Proximal point iterations: an eigenvalue e of A leaves the fraction (m / (e + m))^steps of the way to the minimum,
   * m = damping * trace (A). So there is no threshold at which the result jumps. */
  Eigen::Vector3d minimumNear (const Eigen::Vector3d& start) const
  {
    constexpr double damping = 1e-3;
    constexpr int steps = 3;
    if (!(weight () > 0.0))
      return start;
    const Eigen::Matrix3d inverse = (A_ + damping * weight () * Eigen::Matrix3d::Identity ()).inverse ();
    Eigen::Vector3d x = start;
    for (int step = 0; step < steps; ++step)
      x -= inverse * (A_ * x + b_);
    return x;
  }

private:
  Eigen::Matrix3d A_ = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero ();
  double c_ = 0.0;
};

} // namespace pcl::cosection
