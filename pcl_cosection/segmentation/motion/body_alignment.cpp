// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_alignment.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t most_points = 1500; // of either side
constexpr int iterations = 24;
constexpr float first_gate_m = 0.05f; // distances along the ray that may be one surface
constexpr float last_gate_m = 0.015f;
constexpr double gate_decay = 0.85;
constexpr float same_orientation = 0.5f; // cosine
constexpr int reach_px = 10;             // from a place that was seen through to the surface beside it
constexpr double outline_weight = 0.3;   // of a point there, relative to one on a surface
constexpr double held = 1e-4;            // of the strongest direction's curvature, added to all
constexpr double converged = 1e-5;       // metres

/** \brief One term w |J x - r|^2. */
using AddTerm = std::function<void (const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double residual,
                                    double weight)>;

/** \brief The pixel that \a allowed admits whose reading is nearest to \a q, of those around its own. */
int
nearestBeside (const MotionView& view, const Eigen::Vector3f& q, const std::vector<char>& allowed)
{
  const auto u = static_cast<int> (std::lround (view.camera.fx * q.x () / q.z () + view.camera.cx));
  const auto v = static_cast<int> (std::lround (view.camera.fy * q.y () / q.z () + view.camera.cy));
  int best = -1;
  float best_distance = std::numeric_limits<float>::max ();
  for (int vv = std::max (0, v - reach_px); vv <= std::min (view.camera.height - 1, v + reach_px); ++vv)
    for (int uu = std::max (0, u - reach_px); uu <= std::min (view.camera.width - 1, u + reach_px); ++uu)
    {
      const int i = vv * view.camera.width + uu;
      const float distance = allowed[i] ? (view.points[i] - q).squaredNorm () : best_distance;
      if (distance < best_distance)
      {
        best_distance = distance;
        best = i;
      }
    }
  return best;
}

std::vector<int>
thinned (const std::vector<int>& pixels)
{
  const std::size_t step = 1 + pixels.size () / most_points;
  std::vector<int> result;
  for (std::size_t n = 0; n < pixels.size (); n += step)
    result.push_back (pixels[n]);
  return result;
}

/** \brief The terms of points of one view against the surface of the other. */
class SurfaceTerms
{
public:
  /** \param[in] allowed pixels of \a target that points may be drawn to */
  SurfaceTerms (const MotionView& source, const std::vector<int>& pixels, const MotionView& target,
                std::vector<char> allowed)
      : source_ (source)
      , target_ (target)
      , pixels_ (thinned (pixels))
      , allowed_ (std::move (allowed))
  {}

  std::size_t size () const { return pixels_.size (); }

  /** \brief Costs from 0 to 1, summed. \param[in] add may be null. Points are in the target's sensor frame */
  double visit (const Eigen::Isometry3d& T_target_source, float gate_m, const AddTerm* add) const
  {
    const Eigen::Isometry3f T = T_target_source.cast<float> ();
    double cost = 0.0;
    for (const int i : pixels_)
    {
      const Eigen::Vector3f q = T * source_.points[i];
      const Sighting sighting = sightAt (target_, q);
      if (sighting.pixel < 0 || sighting.ahead_m < -gate_m) // out of view or hidden, perhaps
      {
        cost += 0.5;
        continue;
      }
      const float sigma = 2.0f * differenceSigma (q.z ());
      const int j = sighting.pixel;
      const bool oriented = source_.hasNormal (i) && target_.hasNormal (j);
      if (sighting.ahead_m <= gate_m &&
          (!oriented || target_.normals[j].dot (T.linear () * source_.normals[i]) > same_orientation))
      {
        const Eigen::Vector3f normal = target_.hasNormal (j) ? target_.normals[j] : Eigen::Vector3f (0.0f, 0.0f, -1.0f);
        const float distance = normal.dot (q - target_.points[j]);
        const float size = std::abs (distance) / sigma;
        cost += std::min (1.0f, 0.25f * size * size);
        if (add)
          (*add) (q.cast<double> (), normal.cast<double> (), -distance, 1.0 / (sigma * sigma) / std::max (1.0f, size));
        continue;
      }
      cost += 1.0;
      const int beside = add ? nearestBeside (target_, q, allowed_) : -1;
      if (beside < 0)
        continue;
      const Eigen::Vector3f pull = target_.points[beside] - q;
      const float size = pull.norm () / sigma;
      const double weight = outline_weight / (sigma * sigma) / std::max (1.0f, size);
      for (int axis = 0; axis < 3; ++axis)
        (*add) (q.cast<double> (), Eigen::Vector3d::Unit (axis), pull[axis], weight);
    }
    return cost;
  }

private:
  const MotionView& source_;
  const MotionView& target_;
  std::vector<int> pixels_;
  std::vector<char> allowed_;
};

/** \brief Normal equations of a small motion about a centre, in metres; turns in units of a radius. */
struct SmallMotion
{
  Eigen::Vector3d centre;
  double radius;
  Matrix6d curvature = Matrix6d::Zero ();
  Vector6d slope = Vector6d::Zero ();

  void add (const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double residual, double weight)
  {
    Vector6d row;
    row << direction, (point - centre).cross (direction) / radius;
    curvature.noalias () += weight * row * row.transpose ();
    slope.noalias () += weight * residual * row;
  }

  Vector6d solve () const
  {
    Matrix6d damped = curvature;
    damped.diagonal ().array () += held * curvature.trace () + 1e-12;
    return damped.ldlt ().solve (slope);
  }

  Eigen::Isometry3d motion (const Vector6d& step) const
  {
    const Eigen::Vector3d turn = step.tail<3> () / radius;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
    if (turn.norm () > 0.0)
      T.linear () = Eigen::AngleAxisd (turn.norm (), turn.normalized ()).toRotationMatrix ();
    T.translation () = centre + step.head<3> () - T.linear () * centre;
    return T;
  }
};

} // namespace

Eigen::Isometry3d
alignBody (const BodySightings& body, const std::vector<Eigen::Isometry3d>& guesses)
{
  std::vector<char> of_body (body.now.points.size (), 0);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero ();
  for (const int i : body.pixels)
  {
    of_body[i] = 1;
    centre += body.now.points[i].cast<double> () / static_cast<double> (body.pixels.size ());
  }
  double squares = 0.0;
  for (const int i : body.pixels)
    squares += (body.now.points[i].cast<double> () - centre).squaredNorm ();
  const double radius = std::max (
      1e-3, std::sqrt (squares / static_cast<double> (std::max<std::size_t> (1, body.pixels.size ()))));
  std::vector<char> surface (body.then.points.size ());
  for (std::size_t i = 0; i < surface.size (); ++i)
    surface[i] = !body.then.room[i] && std::isfinite (body.then.points[i].z ());

  const SurfaceTerms forward (body.now, body.pixels, body.then, std::move (surface));
  const auto costAt = [&] (const Eigen::Isometry3d& T) {
    return forward.visit (T, first_gate_m, nullptr) / static_cast<double> (std::max<std::size_t> (1, forward.size ()));
  };
  Eigen::Isometry3d T = *std::min_element (guesses.begin (), guesses.end (),
                                           [&] (const auto& a, const auto& b) { return costAt (a) < costAt (b); });
  const Eigen::Isometry3d T_now_then = T.inverse ();
  std::vector<int> near; // what is gone and far from the body is another's
  for (const int j : body.gone)
    if (nearestBeside (body.now, (T_now_then * body.then.points[j].cast<double> ()).cast<float> (), of_body) >= 0)
      near.push_back (j);
  const SurfaceTerms backward (body.then, thinned (near), body.now, of_body);
  double gate = first_gate_m;
  for (int n = 0; n < iterations; ++n)
  {
    SmallMotion motion{T * centre, radius};
    const AddTerm addForward = [&motion] (const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                                          double residual,
                                          double weight) { motion.add (point, direction, residual, weight); };
    // A term of the inverse motion: a point of then should go by the residual to the body, that is, the body by its
    // opposite to the point.
    const AddTerm addBackward = [&motion, &T] (const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                                               double residual, double weight) {
      motion.add (T * point, T.linear () * direction, -residual, weight);
    };
    forward.visit (T, static_cast<float> (gate), &addForward);
    backward.visit (T.inverse (), static_cast<float> (gate), &addBackward);
    const Vector6d step = motion.solve ();
    T = motion.motion (step) * T;
    gate = std::max<double> (last_gate_m, gate * gate_decay);
    if (step.norm () < converged && gate <= last_gate_m)
      break;
  }
  return T;
}

} // namespace pcl::cosection
