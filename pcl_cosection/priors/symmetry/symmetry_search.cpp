// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "symmetry_search.h"

#include "climb.h"
#include "footprint.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int mirror_angles = 60;
constexpr int axis_heights = 11;
constexpr int coarse_turns = 8, fine_turns = 12, all_turns = 32;
constexpr std::size_t mirrors_to_pair = 6;
constexpr double same_mirror = 0.3;          // radians
constexpr double least_side = 0.05;          // of the samples, on either side of a mirror plane
constexpr double slack_vox = 0.35;           // evidence for a mirror plane is no more exact, ...
constexpr double slack_alone_vox = 0.75;     // ... without a plane less so: less was seen free beside the object
constexpr double turn_weight = 4.0;          // independent motions of a full turn, ...
constexpr double ball_weight = 9.0;          // ... of all turns, ...
constexpr double mirrors_weight = 3.0;       // ... of two mirror planes at right angles, and ...
constexpr double three_mirrors_weight = 6.0; // ... of three
constexpr int axis_rounds = 20;
constexpr double least_evidence = 0.3;      // log-likelihood ratio; without a plane, per copy
constexpr double sure_evidence = 1.0;       // half of the copies are on observed surface
constexpr double most_contradiction = 0.1;  // share of the copies
constexpr double parallel = 0.9;            // cosine of two axes
constexpr double as_much = 0.8;             // of the largest value, where more motions are preferred ...
constexpr double more_contradiction = 0.05; // ... though they are contradicted as much more often

bool
isPossible (const Symmetry& symmetry)
{
  return symmetry.evidence.contradiction < most_contradiction &&
         (symmetry.on_plane ? symmetry.value () : symmetry.evidence.logLikelihoodRatio ()) > least_evidence;
}

Symmetry
symmetryOf (const CopyJudge& judge, double weight, Motions motions)
{
  const CopyEvidence evidence = judge.judge (motions);
  return {std::move (motions), weight, evidence, judge.onPlane ()};
}

/** \brief Whether a plane has samples on both sides. A mirror plane behind all that was seen could not be refuted. */
bool
isAmidst (const std::vector<OrientedPoint>& samples, const Eigen::Vector3d& normal, double offset)
{
  const auto beyond = std::count_if (samples.begin (), samples.end (), [&] (const OrientedPoint& sample) {
    return normal.dot (sample.position.cast<double> ()) > offset;
  });
  const double share = static_cast<double> (beyond) / static_cast<double> (samples.size ());
  return share > least_side && share < 1.0 - least_side;
}

MakeMotions
mirrorPlane (const CopyJudge& judge, const Footprint& footprint)
{
  return [&] (const Parameters& p) { // angle, offset
    const Eigen::Vector3d normal = footprint.direction (p[0]);
    const double offset = footprint.across (normal, p[1]);
    return isAmidst (judge.samples (), normal, offset) ? Motions{reflection (normal, offset)} : Motions ();
  };
}

/** \brief The best mirror planes, of clearly different directions. */
std::vector<RatedParameters>
bestMirrors (const CopyJudge& judge, const Footprint& footprint)
{
  const MakeMotions motions = mirrorPlane (judge, footprint);
  std::vector<Parameters> all;
  for (int i = 0; i < mirror_angles; ++i)
    for (int j = -footprint.steps (); j <= footprint.steps (); ++j)
      all.push_back ({M_PI * i / mirror_angles, j * footprint.step ()});
  std::vector<RatedParameters> best;
  const auto isNew = [&best] (const Parameters& mirror) {
    return std::none_of (best.begin (), best.end (), [&] (const RatedParameters& other) {
      const double between = std::abs (mirror[0] - other.at[0]);
      return std::min (between, M_PI - between) < same_mirror;
    });
  };
  BestFirst candidates (judge, motions, std::move (all));
  while (best.size () < mirrors_to_pair)
  {
    RatedParameters mirror = candidates.next (isNew);
    if (mirror.at.empty ())
      break;
    best.push_back (std::move (mirror));
  }
  return best;
}

/** \brief Add the full turn about the best of some axes.
 * \param[in] motions of so many copies about an axis
 * \param[in] least evidence for it */
void
addBestTurn (const CopyJudge& judge, const std::function<MakeMotions (int)>& motions,
             const std::vector<Parameters>& axes, const Parameters& steps, double least,
             std::vector<Symmetry>& symmetries)
{
  RatedParameters best = bestOf (judge, motions (coarse_turns), axes);
  if (best.at.empty ())
    return;
  climb (judge, motions (fine_turns), steps, best);
  if (best.ratio <= least)
    return;
  center (judge, motions (fine_turns), steps, best);
  symmetries.push_back (symmetryOf (judge, turn_weight, motions (all_turns) (best.at)));
}

/** \brief Add the full turn about an axis across the footprint's plane. It lies in a vertical mirror plane. */
void
addTurnAboutVertical (const CopyJudge& judge, const Footprint& footprint, const std::vector<RatedParameters>& mirrors,
                      double least, std::vector<Symmetry>& symmetries)
{
  const auto motions = [&] (int count) -> MakeMotions {
    return [&footprint, count] (const Parameters& p) {
      return turns (footprint.place (p[0], p[1]), footprint.up (), count);
    };
  };
  std::vector<Parameters> axes;
  for (const RatedParameters& mirror : mirrors)
    for (int j = -footprint.steps (); j <= footprint.steps (); ++j)
    {
      const double c = std::cos (mirror.at[0]), s = std::sin (mirror.at[0]);
      const double along = j * footprint.step ();
      axes.push_back ({c * mirror.at[1] - s * along, s * mirror.at[1] + c * along});
    }
  addBestTurn (judge, motions, axes, {0.5 * footprint.step (), 0.5 * footprint.step ()}, least, symmetries);
}

/** \brief Add the full turn about an axis along the plane. It lies in a vertical mirror plane. */
void
addTurnAboutHorizontal (const CopyJudge& judge, const Footprint& footprint, const std::vector<RatedParameters>& mirrors,
                        std::vector<Symmetry>& symmetries)
{
  const auto motions = [&] (int count) -> MakeMotions {
    return [&footprint, count] (const Parameters& p) { // angle and offset of the mirror plane, height
      const Eigen::Vector3d along = footprint.direction (p[0] + M_PI_2), aside = footprint.direction (p[0]);
      return turns (footprint.place (0.0, 0.0) + p[1] * aside + p[2] * footprint.up (), along, count);
    };
  };
  std::vector<Parameters> axes;
  for (const RatedParameters& mirror : mirrors)
    for (int k = 1; k <= axis_heights; ++k)
      axes.push_back ({mirror.at[0], mirror.at[1], footprint.top () * k / (axis_heights + 1)});
  const Parameters steps = {M_PI_2 / mirror_angles, footprint.step (), 0.5 * footprint.top () / (axis_heights + 1)};
  addBestTurn (judge, motions, axes, steps, -std::numeric_limits<double>::infinity (), symmetries);
}

/** \brief Add a mirror plane, and two at right angles. \param[in] with_level also three, of which one
 * is level \param[in] least evidence for one or two */
void
addMirrors (const CopyJudge& judge, const Footprint& footprint, const std::vector<RatedParameters>& mirrors,
            bool with_level, double least, std::vector<Symmetry>& symmetries)
{
  const MakeMotions one = mirrorPlane (judge, footprint);
  const MakeMotions two = [&] (const Parameters& p) { // angle, offsets
    Motions motions = one ({p[0], p[1]});
    const Motions second = one ({p[0] + M_PI_2, p[2]});
    if (motions.empty () || second.empty ())
      return Motions ();
    motions.push_back (second.front ());
    motions.push_back (motions.front () * second.front ());
    return motions;
  };
  const std::optional<double> across = footprint.angleOfWalls (judge.samples ());
  const double turn = M_PI_2 / mirror_angles, shift = 0.5 * footprint.step (),
               slack_m = (with_level ? slack_alone_vox : slack_vox) * footprint.voxelSize ();
  WantedParameters wanted;
  wanted.slack = {2.0 * turn, slack_m, slack_m, slack_m};
  wanted.value = [&] (const Parameters& p, std::size_t k) -> std::optional<double> {
    if (k == 0)
      return across ? std::optional<double> (*across + M_PI_2 * std::round ((p[0] - *across) / M_PI_2)) : std::nullopt;
    const Eigen::Vector3d n = k == 3 ? footprint.up () : footprint.direction (p[0] + (k == 2 ? M_PI_2 : 0.0));
    std::vector<double> along;
    for (const OrientedPoint& sample : judge.samples ())
      along.push_back (n.dot (sample.position.cast<double> ()) - footprint.across (n, 0.0));
    return 0.5 * (quantile (along, 0.01) + quantile (along, 0.99));
  };
  const Parameters steps_of_one = {turn, shift}, steps_of_two = {turn, shift, shift},
                   steps_of_three = {turn, shift, shift, shift};
  RatedParameters best_one, best_two;
  for (const RatedParameters& coarse : mirrors)
  {
    std::vector<Parameters> pairs;
    for (int j = -footprint.steps (); j <= footprint.steps (); ++j)
      pairs.push_back ({coarse.at[0], coarse.at[1], j * footprint.step ()});
    RatedParameters pair = bestOf (judge, two, pairs);
    climb (judge, two, steps_of_two, pair, JudgedBy::SomeSamples);
    if (pair.ratio > best_two.ratio + least_gain)
      best_two = std::move (pair);
    RatedParameters single = coarse;
    climb (judge, one, steps_of_one, single, JudgedBy::SomeSamples);
    if (single.ratio > best_one.ratio + least_gain)
      best_one = std::move (single);
  }
  climb (judge, one, steps_of_one, best_one);
  climb (judge, two, steps_of_two, best_two);
  center (judge, two, steps_of_two, best_two, wanted);
  if (best_one.ratio > least)
  {
    center (judge, one, steps_of_one, best_one, wanted);
    symmetries.push_back (symmetryOf (judge, 1.0, one (best_one.at)));
  }
  if (best_two.ratio > least)
    symmetries.push_back (symmetryOf (judge, mirrors_weight, two (best_two.at)));
  if (!with_level || best_two.at.empty ())
    return;
  const MakeMotions three = [&] (const Parameters& p) { // angle, offsets
    Motions motions = two ({p[0], p[1], p[2]});
    const double height = footprint.across (footprint.up (), p[3]);
    if (motions.empty () || !isAmidst (judge.samples (), footprint.up (), height))
      return Motions ();
    const Eigen::Affine3d level = reflection (footprint.up (), height);
    for (std::size_t m = 0; m < 3; ++m)
      motions.push_back (level * motions[m]);
    motions.push_back (level);
    return motions;
  };
  std::vector<Parameters> threes;
  for (double height = footprint.bottom (); height <= footprint.top (); height += footprint.step ())
    threes.push_back ({best_two.at[0], best_two.at[1], best_two.at[2], height});
  RatedParameters best = bestOf (judge, three, threes);
  if (best.at.empty ())
    return;
  climb (judge, three, steps_of_three, best);
  center (judge, three, steps_of_three, best, wanted);
  symmetries.push_back (symmetryOf (judge, three_mirrors_weight, three (best.at)));
}

/** \brief Three directions at right angles along which normals are most concentrated: those that maximise the sum of
 * the fourth powers of the normals' components, by fixed-point iteration (Y. Zhai et al., "Complete dictionary learning
 * via l4-norm maximization over the orthogonal group", JMLR 2020). */
Eigen::Matrix3d
axesOfNormals (const std::vector<OrientedPoint>& samples)
{
  Eigen::Matrix3d axes = principalAxes (samples, std::nullopt);
  for (int round = 0; round < axis_rounds; ++round)
  {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero ();
    for (const OrientedPoint& sample : samples)
    {
      const Eigen::Vector3d n = sample.normal.cast<double> ();
      const Eigen::Array3d along = axes.transpose () * n;
      sum += n * along.cube ().matrix ().transpose ();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd (sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    axes = svd.matrixU () * svd.matrixV ().transpose ();
  }
  return axes;
}

void
addSymmetriesAlong (const CopyJudge& judge, const Footprint& footprint, bool has_plane,
                    std::vector<Symmetry>& symmetries)
{
  // Without a plane, there are three directions to choose from, and less was seen free that could refute a symmetry.
  const double least = has_plane ? -std::numeric_limits<double>::infinity () : sure_evidence;
  const std::vector<RatedParameters> mirrors = bestMirrors (judge, footprint);
  addTurnAboutVertical (judge, footprint, mirrors, least, symmetries);
  addMirrors (judge, footprint, mirrors, !has_plane, least, symmetries);
  if (has_plane)
    addTurnAboutHorizontal (judge, footprint, mirrors, symmetries);
}

} // namespace

std::vector<Symmetry>
findSymmetries (const CopyJudge& judge, const VoxelGrid& grid, const Eigen::Vector4d& plane)
{
  std::vector<Symmetry> symmetries;
  if (!judge.hasEnoughSamples ())
    return symmetries;
  if (!plane.head<3> ().isZero ())
  {
    addSymmetriesAlong (judge, Footprint (judge.samples (), grid, plane), true, symmetries);
    return symmetries;
  }
  const Eigen::Matrix3d axes = axesOfNormals (judge.samples ());
  for (int a = 0; a < 3; ++a)
  {
    Eigen::Vector4d across = Eigen::Vector4d::Zero ();
    across.head<3> () = axes.col (a);
    addSymmetriesAlong (judge, Footprint (judge.samples (), grid, across), false, symmetries);
  }
  return symmetries;
}

Symmetry
givenTurn (const CopyJudge& judge, const Eigen::Vector3d& center, const Eigen::Vector3d& axis)
{
  if (!axis.isZero ())
    return symmetryOf (judge, turn_weight, turns (center, axis, all_turns));
  Motions motions;
  for (int k = 0; k < 3; ++k)
    for (const Eigen::Affine3d& motion : turns (center, Eigen::Vector3d::Unit (k), all_turns / 2))
      for (int l = 0; l < 4; ++l)
        motions.push_back (rotation (center, Eigen::Vector3d::Unit ((k + 1) % 3), 0.25 * M_PI * l) * motion);
  return symmetryOf (judge, ball_weight, std::move (motions));
}

std::optional<Symmetry>
likeliest (const std::vector<Symmetry>& symmetries)
{
  double largest = 0.0, contradiction = 0.0; // of the one with the largest value
  for (const Symmetry& s : symmetries)
    if (isPossible (s) && s.value () > largest)
    {
      largest = s.value ();
      contradiction = s.evidence.contradiction;
    }
  std::optional<Symmetry> best;
  for (const Symmetry& s : symmetries)
    if (isPossible (s) && s.value () >= as_much * largest &&
        s.evidence.contradiction <= contradiction + more_contradiction &&
        (!best || s.motions.size () > best->motions.size () ||
         (s.motions.size () == best->motions.size () && s.value () > best->value ())))
      best = s;
  return best;
}

bool
isAboutSameAxis (const Symmetry& a, const Symmetry& b)
{
  if (a.motions.size () != all_turns - 1 || b.motions.size () != all_turns - 1)
    return false;
  const auto axis = [] (const Symmetry& s) { return Eigen::AngleAxisd (s.motions.front ().linear ()).axis (); };
  return std::abs (axis (a).dot (axis (b))) > parallel;
}

bool
isAsLikely (const Symmetry& symmetry, const Symmetry& best)
{
  if (isAboutSameAxis (symmetry, best))
    return isPossible (symmetry);
  return isPossible (symmetry) && symmetry.value () > as_much * best.value ();
}

} // namespace pcl::cosection
