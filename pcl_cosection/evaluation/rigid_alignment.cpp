// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "rigid_alignment.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"
#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl::cosection {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

double
angleOf (const Eigen::Matrix3d& rotation)
{
  const Eigen::Vector3d axis (rotation (2, 1) - rotation (1, 2), rotation (0, 2) - rotation (2, 0),
                              rotation (1, 0) - rotation (0, 1));
  return std::atan2 (axis.norm (), rotation.trace () - 1.0);
}

/** \brief Points in the frame of a surface, and what they say about how they should move. */
class PointToPlane
{
public:
  PointToPlane (const std::vector<Eigen::Vector3d>& points, const SurfaceDistance& surface,
                const RefinementOptions& options)
      : points_ (points)
      , surface_ (surface)
      , options_ (options)
      , centre_ (std::accumulate (points.begin (), points.end (), Eigen::Vector3d (Eigen::Vector3d::Zero ())) /
                 static_cast<double> (points.size ()))
  {
    double squares = 0.0;
    for (const Eigen::Vector3d& p : points)
      squares += (p - centre_).squaredNorm ();
    radius_m_ = std::max (std::sqrt (squares / static_cast<double> (points.size ())), 1e-9);
  }

  const Eigen::Vector3d& centre () const { return centre_; }

  /** \brief Sum up the normal equations of a small motion: a rotation about the centre, radians times radius, and a
   * translation.
   * \return the root mean square distance of the points that count */
  double linearize (const Eigen::Isometry3d& motion, Matrix6d& hessian, Vector6d& gradient) const
  {
    std::vector<SurfaceDistance::Nearest> nearest (points_.size ());
    parallelFor (0, static_cast<int> (points_.size ()), options_.threads,
                 [&] (int n) { nearest[n] = surface_.nearest (motion * points_[n]); });
    hessian.setZero ();
    gradient.setZero ();
    double squares = 0.0, count = 0.0;
    for (std::size_t n = 0; n < points_.size (); ++n)
    {
      const Eigen::Vector3d p = motion * points_[n];
      const double distance = (p - nearest[n].point).norm ();
      if (!(distance < options_.max_distance_m))
        continue;
      squares += distance * distance;
      count += 1.0;
      const double weight = tukeyWeight (distance / options_.max_distance_m);
      Vector6d row;
      row << (p - motion * centre_).cross (nearest[n].normal) / radius_m_, nearest[n].normal;
      hessian += weight * row * row.transpose ();
      gradient += weight * nearest[n].normal.dot (p - nearest[n].point) * row;
    }
    return count > 0.0 ? std::sqrt (squares / count) : 0.0;
  }

  /** \brief The motion that solves the normal equations, without what they leave undetermined. */
  Eigen::Isometry3d step (const Eigen::Isometry3d& motion, const Matrix6d& hessian, const Vector6d& gradient) const
  {
    constexpr double undetermined = 1e-3; // of the best determined motion
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (hessian);
    const double largest = solver.eigenvalues ().maxCoeff ();
    Vector6d x = Vector6d::Zero ();
    for (int n = 0; n < 6; ++n)
      if (solver.eigenvalues ()[n] > undetermined * largest)
      {
        const Vector6d direction = solver.eigenvectors ().col (n);
        x -= direction.dot (gradient) / solver.eigenvalues ()[n] * direction;
      }
    const Eigen::Vector3d omega = x.head<3> () / radius_m_;
    const double angle = omega.norm ();
    const Eigen::Vector3d c = motion * centre_;
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity ();
    result.linear () = angle > 0.0 ? Eigen::AngleAxisd (angle, omega / angle).toRotationMatrix ()
                                   : Eigen::Matrix3d (Eigen::Matrix3d::Identity ());
    result.translation () = c + x.tail<3> () - result.linear () * c;
    return result * motion;
  }

private:
  const std::vector<Eigen::Vector3d>& points_;
  const SurfaceDistance& surface_;
  const RefinementOptions& options_;
  const Eigen::Vector3d centre_;
  double radius_m_ = 1.0;
};

} // namespace

PointAlignment
alignPoints (const std::vector<Eigen::Vector3d>& target, const std::vector<Eigen::Vector3d>& source)
{
  if (target.size () != source.size ())
    throw InvalidArgument ("alignPoints: there must be as many points of both");
  if (target.empty ())
    return {Eigen::Isometry3d::Identity (), false};
  PointAlignment result;
  const auto count = static_cast<Eigen::Index> (target.size ());
  const Eigen::Map<const Eigen::Matrix3Xd> to (target[0].data (), 3, count), from (source[0].data (), 3, count);
  const Eigen::Vector3d to_mean = to.rowwise ().mean (), from_mean = from.rowwise ().mean ();
  const Eigen::Matrix3d covariance = (to.colwise () - to_mean) * (from.colwise () - from_mean).transpose ();
  const Eigen::Vector3d spread = covariance.jacobiSvd ().singularValues ();
  constexpr double on_a_line = 1e-6; // of the largest singular value
  constexpr double in_one_place_m2 = 1e-18;
  const bool is_spread = spread[0] > in_one_place_m2 * static_cast<double> (count);
  result.determined = is_spread && spread[1] > on_a_line * spread[0];
  if (is_spread)
    result.T_target_source.matrix () = Eigen::umeyama (from, to, false);
  else // no rotation is better than another, and the identity is the least surprising one
    result.T_target_source.translation () = to_mean - from_mean;
  return result;
}

Eigen::Isometry3d
medianPose (const std::vector<Eigen::Isometry3d>& poses, const Eigen::Vector3d& centre)
{
  if (poses.empty ())
    throw InvalidArgument ("medianPose: there are no poses");
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity ();
  for (std::size_t n = 0; n < poses.size (); ++n)
  {
    double sum = 0.0;
    for (const Eigen::Isometry3d& other : poses)
      sum += angleOf (poses[n].linear ().transpose () * other.linear ());
    if (sum < least)
    {
      least = sum;
      best = n;
    }
  }
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<double> values;
    for (const Eigen::Isometry3d& pose : poses)
      values.push_back ((pose * centre)[axis]);
    middle[axis] = median (values);
  }
  Eigen::Isometry3d result = poses[best];
  result.translation () = middle - result.linear () * centre;
  return result;
}

void
RefinementOptions::validate () const
{
  for (const double length : {max_distance_m, max_translation_m, max_rotation_rad})
    if (!(length > 0.0))
      throw InvalidArgument ("max_distance_m, max_translation_m and max_rotation_rad must be positive");
  if (max_iterations < 1)
    throw InvalidArgument ("max_iterations must be at least 1");
}

Refinement
refineAlignment (const std::vector<Eigen::Vector3d>& points, const SurfaceDistance& surface,
                 const RefinementOptions& options)
{
  options.validate ();
  if (points.empty ())
    throw InvalidArgument ("refineAlignment: there are no points");
  const PointToPlane problem (points, surface, options);
  Refinement result;
  Matrix6d hessian;
  Vector6d gradient;
  result.rmse_before_m = result.rmse_after_m = problem.linearize (result.correction, hessian, gradient);
  for (int n = 0; n < options.max_iterations && hessian.trace () > 0.0; ++n)
  {
    const Eigen::Isometry3d next = problem.step (result.correction, hessian, gradient);
    const double translation_m = (next * problem.centre () - problem.centre ()).norm ();
    const double rotation_rad = angleOf (next.linear ());
    if (translation_m > options.max_translation_m || rotation_rad > options.max_rotation_rad)
    {
      result.limited = true;
      break;
    }
    const Eigen::Isometry3d change = next * result.correction.inverse ();
    result.correction = next;
    result.translation_m = translation_m;
    result.rotation_rad = rotation_rad;
    result.rmse_after_m = problem.linearize (result.correction, hessian, gradient);
    constexpr double small = 1e-9;
    if (angleOf (change.linear ()) < small && (change * problem.centre () - problem.centre ()).norm () < small)
      break;
  }
  return result;
}

} // namespace pcl::cosection
