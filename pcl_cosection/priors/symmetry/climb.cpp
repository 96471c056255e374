// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "climb.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t samples_of_many = 100; // by which many candidates are judged, ...
constexpr std::size_t samples_of_some = 300; // ... and those that are left
constexpr std::size_t copies_at_once = 8;    // are judged, before it is asked which candidate is the best
constexpr double about_as_good = 0.02;       // difference of log-likelihood ratios
constexpr double center_step = 0.25;         // of a climb's first step
constexpr int most_steps = 8;

/** \brief How finely parameters are searched. */
struct Fineness
{
  int halvings_of_some = 5; // of the steps of a climb among several, whose best will be climbed further, ...
  int halvings = 5;         // ... and of others
  int bisections = 6;       // of the last step within the range in which the evidence is about as good
};

/** \brief Few samples tell parameters no more finely apart than the evidence is exact: a 16th of a voxel will do. */
Fineness
finenessFor (const CopyJudge& judge)
{
  return judge.samples ().size () < samples_of_some ? Fineness{2, 3, 3} : Fineness ();
}

/** \brief How far a parameter can go until the evidence falls below a limit. \param[in] step with a sense */
double
reachOf (const CopyJudge& judge, const MakeMotions& motions, const Parameters& from, std::size_t k, double step,
         double limit)
{
  const auto holds = [&] (double shift) {
    Parameters next = from;
    next[k] += shift;
    return ratioOf (judge, motions (next)) >= limit;
  };
  const int bisections = finenessFor (judge).bisections;
  double good = 0.0, bad = step;
  for (; std::abs (bad) < most_steps * std::abs (step) && holds (bad); bad += step)
    good = bad;
  for (int round = 0; round < bisections; ++round)
    (holds (0.5 * (good + bad)) ? good : bad) = 0.5 * (good + bad);
  return good;
}

/** \brief Judge by every so manieth sample. */
std::size_t
strideFor (const CopyJudge& judge, std::size_t samples)
{
  return judge.samples ().size () / samples + 1;
}

} // namespace

double
ratioOf (const CopyJudge& judge, const Motions& motions, std::size_t stride)
{
  return motions.empty () ? -std::numeric_limits<double>::infinity ()
                          : judge.judge (motions, stride).logLikelihoodRatio ();
}

BestFirst::BestFirst (const CopyJudge& judge, const MakeMotions& motions, std::vector<Parameters> all) : judge_ (judge)
{
  const std::size_t stride = strideFor (judge, samples_of_many);
  candidates_.reserve (all.size ());
  std::vector<Bound> bounds;
  for (Parameters& at : all)
  {
    Judgement judgement (motions (at), judge, stride);
    judgement.goOn (judge, copies_at_once);
    bounds.push_back ({judgement.most (), candidates_.size ()});
    candidates_.push_back ({std::move (at), std::move (judgement)});
  }
  queue_ = std::priority_queue<Bound> (std::less<Bound> (), std::move (bounds));
}

RatedParameters
BestFirst::next (const std::function<bool (const Parameters&)>& is_wanted)
{
  while (!queue_.empty ())
  {
    const auto [most, n] = queue_.top ();
    queue_.pop ();
    Candidate& candidate = candidates_[n];
    if (!is_wanted (candidate.at))
      continue;
    if (candidate.judgement.isDone ())
      return {candidate.at, most};
    candidate.judgement.goOn (judge_, copies_at_once);
    queue_.push ({candidate.judgement.most (), n});
  }
  return {};
}

RatedParameters
bestOf (const CopyJudge& judge, const MakeMotions& motions, const std::vector<Parameters>& all)
{
  RatedParameters best = BestFirst (judge, motions, all).next ([] (const Parameters&) { return true; });
  return std::isfinite (best.ratio) ? best : RatedParameters ();
}

void
climb (const CopyJudge& judge, const MakeMotions& motions, Parameters steps, RatedParameters& best, JudgedBy judged_by)
{
  if (best.at.empty ())
    return;
  const std::size_t stride = judged_by == JudgedBy::SomeSamples ? strideFor (judge, samples_of_some) : 1;
  best.ratio = ratioOf (judge, motions (best.at), stride);
  const Fineness fineness = finenessFor (judge);
  const int halvings = judged_by == JudgedBy::SomeSamples ? fineness.halvings_of_some : fineness.halvings;
  const std::size_t neighbours = 2 * steps.size ();
  for (int round = 0; round < halvings; ++round)
  {
    // The neighbours in turn, until each of them was found to be no better.
    std::size_t back = neighbours; // the one from which the last step came
    for (std::size_t n = 0, no_better = 0; no_better < neighbours; n = (n + 1) % neighbours)
    {
      const std::size_t k = n / 2, opposite = n ^ 1U;
      Parameters next = best.at;
      next[k] += n % 2 == 0 ? -steps[k] : steps[k];
      const double ratio = n == back ? best.ratio : ratioOf (judge, motions (next), stride);
      ++no_better;
      if (ratio > best.ratio + least_gain)
      {
        best = {std::move (next), ratio};
        back = opposite;
        no_better = 0;
      }
    }
    for (double& step : steps)
      step *= 0.5;
  }
}

void
center (const CopyJudge& judge, const MakeMotions& motions, const Parameters& steps, RatedParameters& best,
        const WantedParameters& wanted)
{
  if (best.ratio < 0.0)
    return;
  for (std::size_t k = 0; k < steps.size (); ++k)
  {
    const double limit = ratioOf (judge, motions (best.at)) - about_as_good, step = center_step * steps[k];
    const double low = reachOf (judge, motions, best.at, k, -step, limit);
    const double high = reachOf (judge, motions, best.at, k, step, limit);
    const std::optional<double> value = wanted.value ? wanted.value (best.at, k) : std::nullopt;
    best.at[k] += value ? std::clamp (*value - best.at[k], std::max (low, -wanted.slack[k]),
                                      std::min (high, wanted.slack[k]))
                        : 0.5 * (low + high);
  }
}

} // namespace pcl::cosection
