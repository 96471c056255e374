// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "continuation.h"

#include "object_image.h"
#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/symmetry/copy_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr float end_vox = 4.0f;           // length of the object's end beside what hides it
constexpr std::size_t least_points = 10;  // of the end that are about to be hidden; fewer are noise at edges
constexpr std::size_t most_points = 2000; // of the object, to find the direction
constexpr int directions = 72;            // along the plane
constexpr int copies = 4;                 // of the end, each half its length farther, into what was seen
constexpr double least_ratio = 1.0;       // log-likelihood per copy: the cross-section is constant
constexpr double least_hidden = 0.7;      // of the end, elsewhere than the object: it may go on so far
constexpr double seen_again = 0.5;        // of the end: the object is seen on the other side of what hides it
constexpr double turned_weight = 0.5;     // of a copy on surface of another orientation, as a contradiction
constexpr float across_cosine = 0.5f;     // of a normal and the direction: surface that does not go on along it
constexpr double outlier_share = 0.01;    // of the points, at either end

/** \brief What all views together show of a place: free space in one of them decides. */
Shown
shownBy (const std::vector<ObjectImage>& views, const OrientedPoint& point)
{
  Shown shown = Shown::Nothing;
  for (const ObjectImage& view : views)
  {
    const Shown here = view.at (point);
    if (here == Shown::Free)
      return here;
    if (shown != Shown::Object && here != Shown::Nothing)
      shown = here;
  }
  return shown;
}

OrientedPoint
shifted (const OrientedPoint& point, const Eigen::Vector3f& by)
{
  return {point.position + by, point.normal};
}

/** \brief Shares of the points, moved, of which the views show this or that. */
struct Shares
{
  double free = 0.0, own = 0.0, turned = 0.0, behind_own = 0.0, behind_other = 0.0;

  /** \brief Of those that are not where the object is, or behind it. */
  double hiddenElsewhere () const
  {
    const double elsewhere = 1.0 - own - turned - behind_own;
    return elsewhere > 0.0 ? behind_other / elsewhere : 0.0;
  }
};

Shares
sharesOf (const std::vector<ObjectImage>& views, const std::vector<OrientedPoint>& points, const Eigen::Vector3f& by)
{
  std::array<std::size_t, 6> counts{};
  for (const OrientedPoint& point : points)
  {
    Shown shown = shownBy (views, shifted (point, by));
    if (shown == Shown::Object && std::abs (point.normal.dot (by)) > across_cosine * by.norm ())
      shown = Shown::Turned; // it would be another part of the surface
    ++counts[static_cast<std::size_t> (shown)];
  }
  const auto share = [&] (Shown shown) {
    return static_cast<double> (counts[static_cast<std::size_t> (shown)]) / static_cast<double> (points.size ());
  };
  return {share (Shown::Free), share (Shown::Object), share (Shown::Turned), share (Shown::BehindOwn),
          share (Shown::BehindOther)};
}

/** \brief How far points reach along a direction, but for a few. */
double
extentAlong (const std::vector<OrientedPoint>& points, const Eigen::Vector3f& direction)
{
  std::vector<double> along;
  for (const OrientedPoint& point : points)
    along.push_back (direction.dot (point.position));
  return trimmedMax (along, outlier_share) - trimmedMin (along, outlier_share);
}

/** \brief Where an object may go on: its points that something nearer hides when they are moved by a vector, and those
 * over and below them. */
class Ends
{
public:
  Ends (const std::vector<ObjectImage>& views, const std::vector<OrientedPoint>& points, const Eigen::Matrix3d& axes,
        double cell_m)
      : views_ (views)
      , points_ (points)
  {
    for (const OrientedPoint& point : points)
    {
      const Eigen::Vector3d p = axes.transpose () * point.position.cast<double> () / cell_m;
      const auto cell = cellOf (Eigen::Vector3d (p.x (), p.y (), 0.0));
      cell_of_.push_back (cell ? cells_.add (*cell) : cells_.add (CellIndex::Zero ()));
    }
  }

  std::vector<OrientedPoint> towards (const Eigen::Vector3f& by) const
  {
    std::vector<bool> in_end (cells_.size (), false);
    for (std::size_t p = 0; p < points_.size (); ++p)
    {
      const OrientedPoint copy = shifted (points_[p], by);
      if (shownBy (views_, copy) == Shown::BehindOther &&
          std::any_of (views_.begin (), views_.end (),
                       [&] (const ObjectImage& view) { return view.isBehindNearer (copy, points_[p]); }))
        in_end[cell_of_[p]] = true;
    }
    std::vector<OrientedPoint> end;
    for (std::size_t p = 0; p < points_.size (); ++p)
      if (in_end[cell_of_[p]])
        end.push_back (points_[p]);
    return end;
  }

private:
  const std::vector<ObjectImage>& views_;
  const std::vector<OrientedPoint>& points_;
  OccupiedCells cells_;              // of the plane
  std::vector<std::size_t> cell_of_; // by point
};

/** \brief The direction in which an object goes on with a constant cross-section; zero if in none. */
Eigen::Vector3f
directionOf (const std::vector<ObjectImage>& views, const Ends& ends, const Eigen::Matrix3d& axes, float step_m)
{
  struct Candidate
  {
    Eigen::Vector3f direction;
    std::vector<OrientedPoint> end;
  };
  std::vector<Candidate> candidates;
  std::size_t largest = 0;
  for (int d = 0; d < directions; ++d)
  {
    const double angle = 2.0 * M_PI * d / directions;
    const Eigen::Vector3f direction = (std::cos (angle) * axes.col (0) + std::sin (angle) * axes.col (1))
                                          .cast<float> ();
    candidates.push_back ({direction, ends.towards (2.0f * step_m * direction)});
    largest = std::max (largest, candidates.back ().end.size ());
  }
  Eigen::Vector3f best = Eigen::Vector3f::Zero ();
  double most_ratio = least_ratio;
  for (const auto& [direction, end] : candidates)
  {
    if (end.size () < least_points || 2 * end.size () < largest ||
        sharesOf (views, end, 2.0f * step_m * direction).hiddenElsewhere () < least_hidden)
      continue;
    CopyEvidence evidence;
    for (int n = 1; n <= copies; ++n)
    {
      const Shares shares = sharesOf (views, end, -static_cast<float> (n) * step_m * direction);
      evidence.support += shares.own / copies;
      evidence.contradiction += (shares.free + turned_weight * shares.turned) / copies;
    }
    if (evidence.logLikelihoodRatio () > most_ratio)
    {
      most_ratio = evidence.logLikelihoodRatio ();
      best = direction;
    }
  }
  return best;
}

/** \brief How many steps the end goes on: until the object is seen again or, as all lengths are as likely, half as many
 * as it can. */
int
stepsOf (const std::vector<ObjectImage>& views, const std::vector<OrientedPoint>& end, const Eigen::Vector3f& step,
         double seen_m)
{
  int n = 1;
  for (; n * step.norm () < seen_m; ++n)
  {
    const Shares shares = sharesOf (views, end, static_cast<float> (n) * step);
    if (n > copies && shares.own > seen_again)
      return n;
    if (n > 1 && shares.hiddenElsewhere () < least_hidden)
      break;
  }
  return n / 2;
}

} // namespace

Continuation
continuedBehindOthers (const Observation& object, const Eigen::Vector4d& plane)
{
  const std::vector<OrientedPoint>& points = object.points ();
  std::vector<ObjectImage> views;
  for (const auto& [view, T_object_sensor] : object.views)
    views.emplace_back (*view, T_object_sensor, *object.all_points, object.voxel_size_m);
  std::vector<OrientedPoint> some;
  for (std::size_t p = 0; p < points.size (); p += points.size () / most_points + 1)
    some.push_back (points[p]);
  const Eigen::Matrix3d axes = principalAxes (points, std::optional<Eigen::Vector3d> (plane.head<3> ()));
  const float step_m = 0.5f * end_vox * static_cast<float> (object.voxel_size_m);
  const Eigen::Vector3f direction = directionOf (views, Ends (views, some, axes, step_m), axes, step_m);
  Continuation continuation;
  continuation.direction = direction.cast<double> ();
  if (direction.isZero ())
    return continuation;
  const Eigen::Vector3f step = step_m * direction;
  const std::vector<OrientedPoint> end = Ends (views, points, axes, step_m).towards (2.0f * step);
  const int steps = stepsOf (views, end, step, extentAlong (points, direction));
  for (int n = 1; n <= steps; ++n)
    for (const OrientedPoint& point : end)
      if (const OrientedPoint copy = shifted (point, static_cast<float> (n) * step);
          shownBy (views, copy) == Shown::BehindOther)
        continuation.points.push_back (copy);
  return continuation;
}

} // namespace pcl::cosection
