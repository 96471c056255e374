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
constexpr float even = 0.25f;                // of the angle between neighbours: as large as usual, ...
constexpr std::size_t steps_to_learn = 5000; // ... which so many tell
constexpr int samples = 1000;
constexpr int adjustments = 15;
constexpr double worth_adjusting = 0.7; // of the most lines so far that pass by a sample's place
constexpr int most_adjusted = 50;
constexpr std::size_t most_places = 3, most_views = 16;
constexpr double at_sensor = 0.01;             // of its length, from an end of a jump
constexpr std::size_t least_meeting = 30;      // lines ...
constexpr double least_meeting_share = 0.1;    // ... of all, ...
constexpr double least_meeting_of_view = 0.02; // ... or of all of several views
constexpr double least_spread = 1e-3; // mean squared sine of the angle between the lines and their mean direction

/** \brief Two points, the second of which was measured after the first and lies far behind or before it. */
struct Jump
{
  std::size_t index; // of the first one
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
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (points[i].allFinite ())
    {
      finite.push_back (points[i]);
      indices.push_back (i);
    }
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
    jumps.push_back ({indices[i], finite[i].cast<double> (), finite[i + 1].cast<double> (),
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

/** \brief Places that many lines pass by, the one with the most first. \param[in] least lines of each */
std::vector<Eigen::Vector3d>
findPlaces (std::vector<Jump> jumps, std::size_t most, std::size_t least)
{
  std::vector<Eigen::Vector3d> places;
  while (places.size () < most && jumps.size () >= least)
  {
    const auto place = findMeeting (jumps);
    if (!place)
      break;
    const std::size_t before = jumps.size ();
    jumps.erase (
        std::remove_if (jumps.begin (), jumps.end (), [&] (const Jump& jump) { return passes (jump, *place, loose); }),
        jumps.end ());
    if (before - jumps.size () < least)
      break;
    places.push_back (*place);
  }
  return places;
}

std::size_t
enough (const std::vector<Jump>& jumps, double share)
{
  return std::max (least_meeting, static_cast<std::size_t> (share * static_cast<double> (jumps.size ())));
}

/** \brief For each jump the place of its view: the fewest jumps miss theirs, and views change seldom. */
std::vector<std::size_t>
dividedAmong (const std::vector<Eigen::Vector3d>& places, const std::vector<Jump>& jumps)
{
  std::vector<double> cost (places.size (), 0.0);
  std::vector<std::vector<std::size_t>> before (jumps.size (), std::vector<std::size_t> (places.size ()));
  for (std::size_t j = 0; j < jumps.size (); ++j)
  {
    const auto least = static_cast<std::size_t> (std::min_element (cost.begin (), cost.end ()) - cost.begin ());
    const double changed = cost[least] + static_cast<double> (least_meeting);
    for (std::size_t k = 0; k < places.size (); ++k)
    {
      before[j][k] = cost[k] <= changed ? k : least;
      cost[k] = std::min (cost[k], changed) + (passes (jumps[j], places[k], loose) ? 0.0 : 1.0);
    }
  }
  std::vector<std::size_t> place (jumps.size ());
  auto at = static_cast<std::size_t> (std::min_element (cost.begin (), cost.end ()) - cost.begin ());
  for (std::size_t j = jumps.size (); j-- > 0;)
  {
    place[j] = at;
    at = before[j][at];
  }
  return place;
}

/** \brief Angles from each point to the next one as seen from \a sensor; chords of the unit sphere. */
std::vector<float>
turnsBetween (const std::vector<Eigen::Vector3f>& points, std::size_t begin, std::size_t end,
              const Eigen::Vector3d& sensor)
{
  std::vector<float> turns;
  for (std::size_t i = begin; i + 1 < end; ++i)
    turns.push_back (
        ((points[i + 1].cast<double> () - sensor).normalized () - (points[i].cast<double> () - sensor).normalized ())
            .cast<float> ()
            .norm ());
  return turns;
}

float
usualTurn (const std::vector<Eigen::Vector3f>& points, std::size_t begin, std::size_t end,
           const Eigen::Vector3d& sensor)
{
  std::vector<float> turns = turnsBetween (points, begin, end, sensor);
  turns.erase (std::remove_if (turns.begin (), turns.end (), [] (float turn) { return !std::isfinite (turn); }),
               turns.end ());
  return turns.empty () ? 0.0f : upperMedian (turns);
}

/** \brief Where a view from \a first ends and one from \a second begins: a sensor turns by the same angle from pixel to
 * pixel. \param[in] last, next indices of points of the two */
std::size_t
changeBetween (const std::vector<Eigen::Vector3f>& points, std::size_t last, std::size_t next,
               const Eigen::Vector3d& first, const Eigen::Vector3d& second)
{
  const auto missesOf = [&] (const Eigen::Vector3d& sensor, float usual) {
    std::vector<int> misses;
    for (const float turn : turnsBetween (points, last, next, sensor))
      misses.push_back (std::abs (turn - usual) <= even * usual ? 0 : 1);
    return misses;
  };
  const std::vector<int> of_first = missesOf (first,
                                              usualTurn (points, last - std::min (last, steps_to_learn), last, first));
  const std::vector<int> of_second = missesOf (
      second, usualTurn (points, next, std::min (points.size (), next + steps_to_learn), second));
  std::size_t best = last + 1;
  int cost = 0, least = 0;
  for (std::size_t i = 0; i < of_first.size (); ++i)
    if (cost += of_first[i] - of_second[i]; cost < least)
    {
      least = cost;
      best = last + i + 2;
    }
  return std::min (best, next);
}

} // namespace

std::vector<Eigen::Vector3d>
locateSensor (const std::vector<Eigen::Vector3f>& points)
{
  const std::vector<Jump> jumps = findJumps (points);
  return findPlaces (jumps, most_places, enough (jumps, least_meeting_share));
}

std::vector<std::size_t>
beginningsOfViews (const std::vector<Eigen::Vector3f>& points)
{
  const std::vector<Jump> jumps = findJumps (points);
  const std::vector<Eigen::Vector3d> places = findPlaces (jumps, most_views, enough (jumps, least_meeting_of_view));
  if (places.size () < 2)
    return {};
  const std::vector<std::size_t> place = dividedAmong (places, jumps);
  std::vector<std::size_t> beginnings = {0};
  for (std::size_t j = 1; j < jumps.size (); ++j)
  {
    if (place[j] == place[j - 1])
      continue;
    const Eigen::Vector3d &before = places[place[j - 1]], &after = places[place[j]];
    std::size_t last = j - 1, next = j; // jumps that pass by
    while (last > 0 && !passes (jumps[last], before, loose))
      --last;
    while (next + 1 < jumps.size () && !passes (jumps[next], after, loose))
      ++next;
    if (const std::size_t beginning = changeBetween (points, jumps[last].index, jumps[next].index + 1, before, after);
        beginning > beginnings.back ())
      beginnings.push_back (beginning);
  }
  return beginnings.size () > 1 ? beginnings : std::vector<std::size_t> ();
}

} // namespace pcl::cosection
