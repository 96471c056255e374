// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "copy_evidence.h"

#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

namespace pcl::cosection {

using Parameters = std::vector<double>;
using MakeMotions = std::function<Motions (const Parameters&)>; // none: the parameters are impossible

/** \brief Values that parameters would have by other evidence than that of copies. */
struct WantedParameters
{
  std::function<std::optional<double> (const Parameters&, std::size_t)> value; // of one of them, given all
  Parameters slack;                                                            // how far it may be from the best
};

/** \brief Parameters of motions, and the evidence for these. */
struct RatedParameters
{
  Parameters at;
  double ratio = -std::numeric_limits<double>::infinity (); // log-likelihood
};

constexpr double least_gain = 1e-6; // of the evidence: less is rounding, and what was found first stays

/** \brief The evidence for motions; minus infinity without any. \param[in] stride as CopyJudge::judge () has it */
double ratioOf (const CopyJudge& judge, const Motions& motions, std::size_t stride = 1);

/** \brief The best of some parameters, judged by a part of the samples; empty if all are impossible. */
RatedParameters bestOf (const CopyJudge& judge, const MakeMotions& motions, const std::vector<Parameters>& all);

/** \brief Hands out parameters, the best first, judged by a part of the samples; those of the same evidence in their
 * order. Judges each only as far as it takes to know which is next. */
class BestFirst
{
public:
  /** \param[in] judge must outlive this */
  BestFirst (const CopyJudge& judge, const MakeMotions& motions, std::vector<Parameters> all);

  /** \brief The next ones of those that are wanted; empty if there are no more. The others are dropped. */
  RatedParameters next (const std::function<bool (const Parameters&)>& is_wanted);

private:
  struct Candidate
  {
    Parameters at;
    Judgement judgement;
  };

  struct Bound
  {
    double most; // of the log-likelihood ratio
    std::size_t candidate;

    bool operator<(const Bound& other) const
    {
      return most < other.most || (most == other.most && candidate > other.candidate);
    }
  };

  const CopyJudge& judge_;
  std::vector<Candidate> candidates_;
  std::priority_queue<Bound> queue_;
};

/** \brief By how many samples motions are judged. */
enum class JudgedBy
{
  SomeSamples, ///< some hundreds, of a climb among several, whose best will be climbed further
  AllSamples
};

/** \brief Climb along each parameter, with steps that are halved when none helps any more.
 * \param[in,out] best where to start, and where it ends; nothing is done if it is empty */
void climb (const CopyJudge& judge, const MakeMotions& motions, Parameters steps, RatedParameters& best,
            JudgedBy judged_by = JudgedBy::AllSamples);

/** \brief Move each parameter within the range in which the evidence is about as good, to its middle or, within its
 * slack, nearer to what is wanted: points are on a surface as wide as a voxel, so the evidence has no sharp peak.
 * \param[in] steps as for the climb \param[in,out] best where the climb ended; nothing is done if its evidence is
 * negative, or it is empty */
void center (const CopyJudge& judge, const MakeMotions& motions, const Parameters& steps, RatedParameters& best,
             const WantedParameters& wanted = {});

} // namespace pcl::cosection
