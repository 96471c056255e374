// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double largest_turn_rad = 0.99 * M_PI;
constexpr double farthest_m = 1e6;  // of a position, from the origin
constexpr double longest_s = 1e9;   // of a time, from zero
constexpr double shortest_s = 1e-6; // from key to key
constexpr double steepest = 3.0;    // of a tangent, in slopes of the chord, for a monotone cubic

void
checkTimes (const std::vector<double>& times, std::size_t values)
{
  if (times.empty () || times.size () != values)
    throw InvalidArgument ("keys: there must be one at least");
  for (std::size_t n = 0; n < times.size (); ++n)
  {
    if (!(std::abs (times[n]) <= longest_s))
      throw InvalidArgument ("keys: the time of key " + std::to_string (n) + " is not within a billion seconds");
    if (n > 0 && !(times[n] - times[n - 1] >= shortest_s))
      throw InvalidArgument ("keys: the time of key " + std::to_string (n) + " is not after that of the key before");
  }
}

/** \brief Tangent between two chords of the slopes \a a and \a b over times of the lengths \a da and \a db. */
double
monotoneTangent (double a, double da, double b, double db)
{
  if (!(a * b > 0.0))
    return 0.0;
  const double wa = 2.0 * db + da, wb = db + 2.0 * da;
  return (wa + wb) / (wa / a + wb / b);
}

Eigen::Vector3d
monotoneTangent (const Eigen::Vector3d& a, double da, const Eigen::Vector3d& b, double db)
{
  Eigen::Vector3d tangent;
  for (int c = 0; c < 3; ++c)
    tangent[c] = monotoneTangent (a[c], da, b[c], db);
  return tangent;
}

/** \brief Cubic from \a a to \a b with the tangents \a ta and \a tb over a time of \a length, at the fraction \a s of
 * it. */
Eigen::Vector3d
hermite (const Eigen::Vector3d& a, const Eigen::Vector3d& ta, const Eigen::Vector3d& b, const Eigen::Vector3d& tb,
         double length, double s)
{
  const double s2 = s * s, s3 = s2 * s;
  // Relative to a: equal values give exactly the same value.
  const Eigen::Vector3d p = a + (3.0 * s2 - 2.0 * s3) * (b - a) + length * ((s3 - 2.0 * s2 + s) * ta + (s3 - s2) * tb);
  return p.cwiseMax (a.cwiseMin (b)).cwiseMin (a.cwiseMax (b)); // rounding
}

/** \brief The keys around \a time: index of the earlier, and the fraction of the way to the next. */
std::pair<std::size_t, double>
find (const std::vector<double>& times, double time)
{
  if (!(time > times.front ()) || times.size () == 1)
    return {0, 0.0};
  if (time >= times.back ())
    return {times.size () - 2, 1.0};
  const auto next = std::upper_bound (times.begin (), times.end (), time);
  const auto n = static_cast<std::size_t> (next - times.begin ()) - 1;
  return {n, (time - times[n]) / (times[n + 1] - times[n])};
}

Eigen::Vector3d
rotationVector (const Eigen::Quaterniond& q)
{
  const Eigen::Quaterniond near = q.w () < 0.0 ? Eigen::Quaterniond (-q.coeffs ()) : q;
  const Eigen::AngleAxisd turn (near);
  return turn.angle () * turn.axis ();
}

Eigen::Quaterniond
rotation (const Eigen::Vector3d& vector)
{
  const double angle = vector.norm ();
  if (!(angle > 0.0))
    return Eigen::Quaterniond::Identity ();
  return Eigen::Quaterniond (Eigen::AngleAxisd (angle, vector / angle));
}

/** \brief Rate of the rotation vector \a v of R exp (v) for an angular velocity \a w in the turned body's frame: the
 * inverse of the right Jacobian of SO(3). */
Eigen::Vector3d
vectorRate (const Eigen::Vector3d& v, const Eigen::Vector3d& w)
{
  const double angle = v.norm ();
  const double factor = angle < 1e-4
                            ? 1.0 / 12.0
                            : 1.0 / (angle * angle) - (1.0 + std::cos (angle)) / (2.0 * angle * std::sin (angle));
  return w + 0.5 * v.cross (w) + factor * v.cross (v.cross (w));
}

/** \brief Whether a cubic from 0 to \a rise over \a length with these rates at an end is monotone in each component. */
bool
staysMonotone (const Eigen::Vector3d& rate, const Eigen::Vector3d& rise, double length)
{
  for (int c = 0; c < 3; ++c)
  {
    const double slope = rise[c] / length;
    if (rate[c] * slope < -1e-12 || std::abs (rate[c]) > steepest * std::abs (slope) + 1e-12)
      return false;
  }
  return true;
}

} // namespace

KeyedVector::KeyedVector (std::vector<double> times, std::vector<Eigen::Vector3d> values)
    : times_ (std::move (times))
    , values_ (std::move (values))
    , tangents_ (values_.size (), Eigen::Vector3d::Zero ())
{
  checkTimes (times_, values_.size ());
  for (const Eigen::Vector3d& v : values_)
    if (!(v.cwiseAbs ().maxCoeff () <= farthest_m))
      throw InvalidArgument ("keys: a position is not within a million metres");
  for (std::size_t n = 1; n + 1 < values_.size (); ++n)
  {
    const double da = times_[n] - times_[n - 1], db = times_[n + 1] - times_[n];
    tangents_[n] = monotoneTangent (Eigen::Vector3d ((values_[n] - values_[n - 1]) / da), da,
                                    Eigen::Vector3d ((values_[n + 1] - values_[n]) / db), db);
  }
}

Eigen::Vector3d
KeyedVector::at (double time) const
{
  const auto [n, s] = find (times_, time);
  if (s <= 0.0)
    return values_[n];
  return hermite (values_[n], tangents_[n], values_[n + 1], tangents_[n + 1], times_[n + 1] - times_[n], s);
}

KeyedRotation::KeyedRotation (std::vector<double> times, std::vector<Eigen::Quaterniond> values)
    : times_ (std::move (times))
    , values_ (std::move (values))
{
  checkTimes (times_, values_.size ());
  for (Eigen::Quaterniond& q : values_)
  {
    if (!(q.coeffs ().allFinite () && q.norm () > 1e-6))
      throw InvalidArgument ("keys: a rotation is no unit quaternion");
    q.normalize ();
  }
  for (std::size_t n = 0; n + 1 < values_.size (); ++n)
  {
    turns_.push_back (rotationVector (values_[n].conjugate () * values_[n + 1]));
    if (turns_.back ().norm () > largest_turn_rad)
      throw InvalidArgument ("keys: the turn from key " + std::to_string (n) + " to key " + std::to_string (n + 1) +
                             " is half a revolution, which may go either way; give a key between them");
  }
  rates_.assign (turns_.size (), {Eigen::Vector3d::Zero (), Eigen::Vector3d::Zero ()});
  for (std::size_t n = 1; n < turns_.size (); ++n)
  {
    const double da = times_[n] - times_[n - 1], db = times_[n + 1] - times_[n];
    // Both turns in the frame of the key between them: a turn leaves its own axis where it is.
    Eigen::Vector3d velocity = monotoneTangent (Eigen::Vector3d (turns_[n - 1] / da), da,
                                                Eigen::Vector3d (turns_[n] / db), db);
    Eigen::Vector3d before = vectorRate (turns_[n - 1], velocity);
    for (int tries = 0; !(staysMonotone (before, turns_[n - 1], da) && staysMonotone (velocity, turns_[n], db));
         ++tries)
    {
      velocity = tries < 6 ? Eigen::Vector3d (0.5 * velocity) : Eigen::Vector3d::Zero ();
      before = vectorRate (turns_[n - 1], velocity);
    }
    rates_[n - 1].second = before;
    rates_[n].first = velocity;
  }
}

Eigen::Quaterniond
KeyedRotation::at (double time) const
{
  const auto [n, s] = find (times_, time);
  if (s <= 0.0)
    return values_[n];
  if (s >= 1.0)
    return values_[n + 1];
  return (values_[n] * rotation (hermite (Eigen::Vector3d::Zero (), rates_[n].first, turns_[n], rates_[n].second,
                                          times_[n + 1] - times_[n], s)))
      .normalized ();
}

KeyedMotion::KeyedMotion (const Eigen::Isometry3d& pose)
    : position_ ({0.0}, {pose.translation ()})
    , rotation_ (KeyedRotation ({0.0}, {Eigen::Quaterniond (pose.linear ())}))
{}

KeyedMotion::KeyedMotion (KeyedVector position, KeyedRotation rotation)
    : position_ (std::move (position))
    , rotation_ (std::move (rotation))
{}

KeyedMotion::KeyedMotion (KeyedVector position, KeyedVector target, const Eigen::Vector3d& up)
    : position_ (std::move (position))
    , target_ (std::move (target))
    , up_ (up)
{}

Eigen::Isometry3d
KeyedMotion::at (double time) const
{
  if (target_)
    return lookAt (position_.at (time), target_->at (time), up_);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = rotation_->at (time).toRotationMatrix ();
  pose.translation () = position_.at (time);
  return pose;
}

} // namespace pcl::cosection
