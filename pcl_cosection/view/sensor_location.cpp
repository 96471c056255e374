// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sensor_location.h"

#include "pcl_cosection/common/quantile.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <random>

namespace pcl::cosection {
namespace {

constexpr int window = 8;              // steps before and after one, whose median is the spacing of the points there
constexpr double jump_spacings = 20.0; // length of a jump, at least
constexpr float longest_step = 5.0f;   // in spacings, of one that is no jump
// Tolerance of the angle between neighbours, in such angles, to find the lines that meet ...
constexpr double loose = 2.0;
constexpr double strict = 0.25; // ... and to adjust where: a missing reading between both ends is noticed then
constexpr std::size_t most_jumps = 2000;
constexpr int samples = 1000;
constexpr int adjustments = 15;
constexpr double worth_adjusting = 0.7; // of the most lines so far that pass by a sample's place
constexpr int most_adjusted = 50;
constexpr std::size_t most_places = 3;
constexpr double at_sensor = 0.01;          // of its length, from an end of a jump
constexpr std::size_t least_meeting = 30;   // lines ...
constexpr double least_meeting_share = 0.1; // ... of all
constexpr double least_spread = 1e-3;       // mean squared sine of the angle between the lines and their mean direction

/** \brief Two points, the second of which was measured after the first and lies far behind or before it. */
struct Jump
{
  Eigen::Vector3d from, to;
  Eigen::Vector3d step_before, step_after; // between neighbours on either side, mean; zero if not known
};

/** \brief Mean of those steps of [begin, end) that are no jumps. */
Eigen::Vector3d
meanStep (const std::vector<Eigen::Vector3f>& points, std::size_t begin, std::size_t end, float longest)
{
  Eigen::Vector3f sum = Eigen::Vector3f::Zero ();
  float count = 0.0f;
  for (std::size_t i = begin; i < end; ++i)
    if (const Eigen::Vector3f step = points[i + 1] - points[i]; step.norm () < longest)
    {
      sum += step;
      ++count;
    }
  return (sum / std::max (1.0f, count)).cast<double> ();
}

std::vector<Jump>
findJumps (const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3f> finite;
  finite.reserve (points.size ());
  std::copy_if (points.begin (), points.end (), std::back_inserter (finite),
                [] (const auto& p) { return p.allFinite (); });
  std::vector<float> steps;
  for (std::size_t i = 0; i + 1 < finite.size (); ++i)
    steps.push_back ((finite[i + 1] - finite[i]).norm ());
  std::vector<Jump> jumps;
  std::vector<float> about;
  for (std::size_t i = window; i + window < steps.size (); ++i)
  {
    const auto here = steps.begin () + static_cast<std::ptrdiff_t> (i);
    if (!std::isfinite (*here) || std::count_if (here - window, here + window + 1,
                                                 [&] (float step) { return jump_spacings * step < *here; }) <= window)
      continue;
    about.assign (here - window, here + window + 1);
    const float longest = longest_step * upperMedian (about);
    jumps.push_back ({finite[i].cast<double> (), finite[i + 1].cast<double> (),
                      meanStep (finite, i - window, i, longest), meanStep (finite, i + 1, i + 1 + window, longest)});
  }
  const std::size_t stride = (jumps.size () + most_jumps - 1) / most_jumps;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < jumps.size (); k += stride)
    jumps[kept++] = jumps[k];
  jumps.resize (kept);
  return jumps;
}

/** \brief How much the direction of sight changes from a point to its neighbour, about a jump, if the sensor is at \a
 * sensor. */
Eigen::Vector3d
pixelPitch (const Jump& jump, const Eigen::Vector3d& sensor)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  int count = 0;
  const auto add = [&] (const Eigen::Vector3d& step, const Eigen::Vector3d& sight) {
    if (step.isZero (0.0))
      return;
    sum += (step - sight * (step.dot (sight) / sight.squaredNorm ())) / sight.norm ();
    ++count;
  };
  add (jump.step_before, jump.from - sensor);
  add (jump.step_after, jump.to - sensor);
  return sum / std::max (1, count);
}

/** \brief Whether the ends of a jump are neighbours as seen from \a sensor. */
bool
passes (const Jump& jump, const Eigen::Vector3d& sensor, double tolerance)
{
  const double nearest = std::min ((jump.from - sensor).norm (), (jump.to - sensor).norm ());
  if (!(nearest > at_sensor * (jump.to - jump.from).norm ()))
    return false; // a missing reading of (0, 0, 0), transformed with the others
  const Eigen::Vector3d pitch = pixelPitch (jump, sensor);
  const Eigen::Vector3d turn = (jump.to - sensor).normalized () - (jump.from - sensor).normalized ();
  return (turn - pitch).squaredNorm () <= tolerance * tolerance * pitch.squaredNorm ();
}

/** \brief Place nearest to two lines. */
std::optional<Eigen::Vector3d>
meeting (const Jump& a, const Jump& b)
{
  const Eigen::Vector3d along_a = (a.to - a.from).normalized ();
  const Eigen::Vector3d along_b = (b.to - b.from).normalized ();
  const double cosine = along_a.dot (along_b);
  const double squared_sine = 1.0 - cosine * cosine;
  if (squared_sine < least_spread)
    return std::nullopt;
  const Eigen::Vector3d between = b.from - a.from;
  const double on_a = (between.dot (along_a) - cosine * between.dot (along_b)) / squared_sine;
  const double on_b = (cosine * between.dot (along_a) - between.dot (along_b)) / squared_sine;
  return 0.5 * (a.from + on_a * along_a + b.from + on_b * along_b);
}

/** \brief Least-squares meeting place of the lines that pass by \a sensor; nothing if they do not determine one. */
std::optional<Eigen::Vector3d>
adjust (const std::vector<Jump>& jumps, const Eigen::Vector3d& sensor, double tolerance)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d right = Eigen::Vector3d::Zero ();
  double weights = 0.0;
  std::size_t count = 0;
  for (const Jump& jump : jumps)
  {
    if (!passes (jump, sensor, tolerance))
      continue;
    // The ray of the first point: where the second would be on it, a pixel beside.
    const Eigen::Vector3d to = jump.to - pixelPitch (jump, sensor) * (jump.to - sensor).norm ();
    const Eigen::Vector3d direction = (to - jump.from).normalized ();
    // What is left of a pixel misses the sensor by as many times its width as the sensor is farther than the jump is
    // long.
    const double weight = (to - jump.from).squaredNorm () / (jump.from - sensor).squaredNorm ();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity () - direction * direction.transpose ();
    normal += weight * across;
    right += weight * (across * (jump.from - sensor));
    weights += weight;
    ++count;
  }
  if (count < least_meeting)
    return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen (normal / weights);
  if (eigen.info () != Eigen::Success || !(eigen.eigenvalues ()[0] > least_spread))
    return std::nullopt;
  return sensor + normal.ldlt ().solve (right);
}

std::size_t
passing (const std::vector<Jump>& jumps, const Eigen::Vector3d& sensor, double tolerance)
{
  return static_cast<std::size_t> (std::count_if (jumps.begin (), jumps.end (),
                                                  [&] (const Jump& jump) { return passes (jump, sensor, tolerance); }));
}

/** \brief The place that most lines pass by exactly, of those that many pass by. */
std::optional<Eigen::Vector3d>
findMeeting (const std::vector<Jump>& jumps)
{
  std::mt19937 random (1);
  std::optional<Eigen::Vector3d> best;
  std::size_t most = 0, most_exactly = 0;
  int adjusted = 0;
  for (int sample = 0; sample < samples && adjusted < most_adjusted; ++sample)
  {
    const std::size_t first = random () % jumps.size ();
    std::optional<Eigen::Vector3d> place = meeting (jumps[first], jumps[random () % jumps.size ()]);
    if (!place || !place->allFinite ())
      continue;
    const std::size_t count = passing (jumps, *place, loose);
    if (static_cast<double> (count) < worth_adjusting * static_cast<double> (most))
      continue;
    most = std::max (most, count);
    ++adjusted;
    for (int k = 0; k < adjustments && place; ++k)
      place = adjust (jumps, *place, loose + (strict - loose) * k / (adjustments - 1));
    if (!place || !place->allFinite ())
      continue;
    if (const std::size_t exactly = passing (jumps, *place, strict); exactly > most_exactly)
    {
      most_exactly = exactly;
      best = place;
    }
  }
  return best;
}

} // namespace

std::vector<Eigen::Vector3d>
locateSensor (const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Jump> jumps = findJumps (points);
  const std::size_t enough = std::max (
      least_meeting, static_cast<std::size_t> (least_meeting_share * static_cast<double> (jumps.size ())));
  std::vector<Eigen::Vector3d> places;
  while (places.size () < most_places && jumps.size () >= enough)
  {
    const auto place = findMeeting (jumps);
    if (!place)
      break;
    const std::size_t before = jumps.size ();
    jumps.erase (
        std::remove_if (jumps.begin (), jumps.end (), [&] (const Jump& jump) { return passes (jump, *place, loose); }),
        jumps.end ());
    if (before - jumps.size () < enough)
      break;
    places.push_back (*place);
  }
  return places;
}

} // namespace pcl::cosection
