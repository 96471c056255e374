// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "climb.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t samples_of_many = 100; // by which many candidates are judged, ...
constexpr std::size_t samples_of_some = 300; // ... and those that are left
constexpr int halvings = 5;                  // of the steps of a climb
constexpr double least_gain = 1e-6;          // of a step
constexpr double about_as_good = 0.02;       // difference of log-likelihood ratios
constexpr double center_step = 0.25;         // of a climb's first step
constexpr int most_steps = 8, bisections = 6;

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

std::vector<RatedParameters>
sortedByEvidence (const CopyJudge& judge, const MakeMotions& motions, std::vector<Parameters> all)
{
  const std::size_t stride = strideFor (judge, samples_of_many);
  std::vector<RatedParameters> candidates;
  for (Parameters& at : all)
  {
    const double ratio = ratioOf (judge, motions (at), stride);
    candidates.push_back ({std::move (at), ratio});
  }
  std::stable_sort (candidates.begin (), candidates.end (),
                    [] (const RatedParameters& a, const RatedParameters& b) { return a.ratio > b.ratio; });
  return candidates;
}

RatedParameters
bestOf (const CopyJudge& judge, const MakeMotions& motions, const std::vector<Parameters>& all)
{
  const std::vector<RatedParameters> sorted = sortedByEvidence (judge, motions, all);
  return sorted.empty () || !std::isfinite (sorted.front ().ratio) ? RatedParameters () : sorted.front ();
}

void
climb (const CopyJudge& judge, const MakeMotions& motions, Parameters steps, RatedParameters& best, JudgedBy judged_by)
{
  if (best.at.empty ())
    return;
  const std::size_t stride = judged_by == JudgedBy::SomeSamples ? strideFor (judge, samples_of_some) : 1;
  best.ratio = ratioOf (judge, motions (best.at), stride);
  for (int round = 0; round < halvings; ++round)
  {
    for (bool moved = true; moved;)
    {
      moved = false;
      for (std::size_t k = 0; k < steps.size (); ++k)
        for (const double sense : {-1.0, 1.0})
        {
          Parameters next = best.at;
          next[k] += sense * steps[k];
          const double ratio = ratioOf (judge, motions (next), stride);
          if (ratio > best.ratio + least_gain)
          {
            best = {std::move (next), ratio};
            moved = true;
          }
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
