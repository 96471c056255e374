// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/trajectory_error.h>

#include "rigid_alignment.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <sstream>
#include <tuple>

namespace pcl::cosection {
namespace {

constexpr double rpe_span_share = 0.02; // by which the spans of pairs may differ
constexpr double rounding = 1e-9;       ///< relative, of stamps in text files

/** \brief The stamps of both trajectories in one list, from which matches are taken out. The nearest pair that remains
 * is always one of neighbours. */
class StampList
{
public:
  StampList (const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate)
  {
    for (std::size_t n = 0; n < truth.size (); ++n)
      entries_.push_back ({truth[n].stamp, true, n, 0, 0});
    for (std::size_t n = 0; n < estimate.size (); ++n)
      entries_.push_back ({estimate[n].stamp, false, n, 0, 0});
    std::stable_sort (entries_.begin (), entries_.end (),
                      [] (const Entry& a, const Entry& b) { return a.stamp < b.stamp; });
    for (std::size_t n = 0; n < entries_.size (); ++n)
    {
      entries_[n].previous = n == 0 ? none : n - 1;
      entries_[n].next = n + 1 == entries_.size () ? none : n + 1;
      offer (entries_[n].previous, n);
    }
  }

  std::vector<PosePair> match (double max_difference_s)
  {
    std::vector<PosePair> pairs;
    while (!candidates_.empty ())
    {
      const auto [difference, a, b] = candidates_.top ();
      if (difference > max_difference_s)
        break;
      candidates_.pop ();
      if (entries_[a].next != b || entries_[b].previous != a)
        continue; // one of them is taken
      const Entry& truth = entries_[a].is_truth ? entries_[a] : entries_[b];
      const Entry& estimate = entries_[a].is_truth ? entries_[b] : entries_[a];
      pairs.push_back ({truth.index, estimate.index});
      const std::size_t before = entries_[a].previous, after = entries_[b].next;
      entries_[a].next = entries_[b].previous = none;
      if (before != none)
        entries_[before].next = after;
      if (after != none)
        entries_[after].previous = before;
      offer (before, after);
    }
    std::sort (pairs.begin (), pairs.end (), [] (const PosePair& x, const PosePair& y) { return x.truth < y.truth; });
    return pairs;
  }

private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max ();

  struct Entry
  {
    double stamp;
    bool is_truth;
    std::size_t index;
    std::size_t previous, next;
  };

  using Candidate = std::tuple<double, std::size_t, std::size_t>;

  void offer (std::size_t a, std::size_t b)
  {
    if (a != none && b != none && entries_[a].is_truth != entries_[b].is_truth)
      candidates_.emplace (entries_[b].stamp - entries_[a].stamp, a, b);
  }

  std::vector<Entry> entries_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

/** \brief Corresponding poses of a truth and an estimate. */
struct Matches
{
  std::vector<StampedPose> truth, estimate;

  std::size_t size () const { return truth.size (); }
};

void
align (const Matches& matches, const TrajectoryOptions& options, TrajectoryError& error)
{
  if (options.alignment == TrajectoryAlignment::First)
    error.T_truth_estimate = matches.truth[0].pose * matches.estimate[0].pose.inverse ();
  if (options.alignment != TrajectoryAlignment::Se3)
    return;
  std::vector<Eigen::Vector3d> target, source;
  for (std::size_t n = 0; n < matches.size (); ++n)
  {
    target.push_back (matches.truth[n].pose.translation ());
    source.push_back (matches.estimate[n].pose.translation ());
  }
  const PointAlignment alignment = alignPoints (target, source);
  error.T_truth_estimate = alignment.T_target_source;
  if (!alignment.determined)
    error.notes.emplace_back (
        matches.size () < 3
            ? "fewer than three poses match: the alignment's rotation is not determined"
            : "the positions are on one line, or in one place: the alignment's rotation is not determined");
}

/** \brief Extent of the positions, metres. */
double
extentOf (const std::vector<StampedPose>& poses)
{
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : poses)
    box.extend (pose.pose.translation ());
  return box.diagonal ().norm ();
}

/** \brief Ask whether the units differ. */
void
compareExtents (const Matches& matches, TrajectoryError& error)
{
  constexpr double least = 50.0; // centimetres are 100 to a metre; what was tracked badly is off by less
  const double ratio = extentOf (matches.estimate) / extentOf (matches.truth);
  const double factor = std::max (ratio, 1.0 / ratio);
  if (!(factor > least) || !std::isfinite (factor))
    return;
  std::ostringstream text;
  text.precision (3);
  text << "the estimate extends " << factor << " times as " << (ratio > 1.0 ? "far" : "little")
       << " as the truth: is one of them not in metres?";
  error.notes.push_back (text.str ());
}

void
computeRpe (const Matches& matches, const TrajectoryOptions& options, TrajectoryError& error)
{
  const auto delta = static_cast<std::size_t> (options.delta);
  if (matches.size () <= delta)
  {
    error.notes.emplace_back ("RPE needs more than " + std::to_string (delta) + " matching poses");
    return;
  }
  // Truth of another rate makes the stamps of matches uneven: the usual span of delta matches says what a gap is.
  std::vector<double> spans;
  for (std::size_t i = 0, j = delta; j < matches.size (); ++i, ++j)
    spans.push_back (matches.truth[j].stamp - matches.truth[i].stamp);
  const double usual = median (spans);
  const double tolerance = std::max (0.5 * *medianPeriod (matches.truth), rpe_span_share * usual) * (1.0 + rounding);
  std::vector<double> translations, rotations;
  for (std::size_t i = 0, j = delta; j < matches.size (); ++i, ++j)
  {
    const double span = matches.truth[j].stamp - matches.truth[i].stamp;
    if (std::abs (span - usual) > tolerance)
    {
      ++error.rpe_left_out;
      continue;
    }
    const Eigen::Isometry3d truth = matches.truth[i].pose.inverse () * matches.truth[j].pose;
    const Eigen::Isometry3d estimate = matches.estimate[i].pose.inverse () * matches.estimate[j].pose;
    const Eigen::Isometry3d difference = truth.inverse () * estimate;
    translations.push_back (difference.translation ().norm ());
    const Eigen::Quaterniond rotation (difference.linear ());
    rotations.push_back (2.0 * std::atan2 (rotation.vec ().norm (), std::abs (rotation.w ())));
  }
  error.rpe_pairs = translations.size ();
  error.rpe_trans_m = errorStatistics (std::move (translations));
  error.rpe_rot_rad = errorStatistics (std::move (rotations));
  if (error.rpe_pairs == 0)
    error.notes.emplace_back ("RPE has no pairs: there is a gap between all of them");
}

} // namespace

void
TrajectoryOptions::validate () const
{
  if (max_difference_s && !(*max_difference_s >= 0.0))
    throw InvalidArgument ("max_difference_s must be 0 or more");
  if (delta < 1)
    throw InvalidArgument ("delta must be at least 1");
}

std::optional<double>
medianPeriod (const std::vector<StampedPose>& trajectory)
{
  if (trajectory.size () < 2)
    return std::nullopt;
  std::vector<double> periods;
  for (std::size_t n = 1; n < trajectory.size (); ++n)
    periods.push_back (trajectory[n].stamp - trajectory[n - 1].stamp);
  return median (periods);
}

std::vector<PosePair>
associatePoses (const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate,
                double max_difference_s)
{
  return StampList (truth, estimate).match (max_difference_s * (1.0 + rounding));
}

TrajectoryError
compareTrajectories (const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate,
                     const TrajectoryOptions& options)
{
  options.validate ();
  if (truth.empty () || estimate.empty ())
    throw DegenerateInput (std::string (truth.empty () ? "the true" : "the estimated") + " trajectory has no poses");
  TrajectoryError error;
  error.truth_poses = truth.size ();
  error.estimate_poses = estimate.size ();
  error.truth_begin_s = truth.front ().stamp;
  error.truth_end_s = truth.back ().stamp;
  error.estimate_begin_s = estimate.front ().stamp;
  error.estimate_end_s = estimate.back ().stamp;
  const auto period = medianPeriod (truth.size () > 1 ? truth : estimate);
  error.max_difference_s = options.max_difference_s.value_or (0.5 * period.value_or (0.0));

  Matches matches;
  for (const PosePair& pair : associatePoses (truth, estimate, error.max_difference_s))
  {
    matches.truth.push_back (truth[pair.truth]);
    matches.estimate.push_back (estimate[pair.estimate]);
  }
  error.matched = matches.size ();
  if (matches.size () == 0)
  {
    std::ostringstream limit;
    limit << error.max_difference_s;
    throw DegenerateInput ("no stamps match within " + limit.str () + ": the truth has " +
                           stampSpan (error.truth_begin_s, error.truth_end_s) + ", the estimate " +
                           stampSpan (error.estimate_begin_s, error.estimate_end_s));
  }
  for (std::size_t n = 1; n < matches.size (); ++n)
  {
    error.largest_gap_s = std::max (error.largest_gap_s, matches.truth[n].stamp - matches.truth[n - 1].stamp);
    error.path_m += (matches.truth[n].pose.translation () - matches.truth[n - 1].pose.translation ()).norm ();
  }
  compareExtents (matches, error);
  align (matches, options, error);
  std::vector<double> distances;
  for (std::size_t n = 0; n < matches.size (); ++n)
    distances.push_back (
        (matches.truth[n].pose.translation () - error.T_truth_estimate * matches.estimate[n].pose.translation ())
            .norm ());
  error.ate_m = errorStatistics (std::move (distances));
  computeRpe (matches, options, error);
  return error;
}

} // namespace pcl::cosection
