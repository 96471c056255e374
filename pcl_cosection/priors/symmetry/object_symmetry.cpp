// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_symmetry.h"

#include "level_mirror.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pcl::cosection {
namespace {

constexpr std::size_t many_motions = 4; // of a full turn; mirror planes have at most three on a plane
constexpr double unmoved = 0.9;         // cosine of a direction with itself, moved

/** \brief Whether motions turn a side over, or turn it about its normal by many angles: their copies of the side are on
 * the side, whatever is behind it. */
bool
copiesOntoItself (const Symmetry& symmetry, const Eigen::Vector3d& normal)
{
  const Motions& motions = symmetry.motions;
  const auto along = [&] (const Eigen::Affine3d& motion) { return normal.dot (motion.linear () * normal); };
  return std::any_of (motions.begin (), motions.end (), [&] (const auto& m) { return along (m) < -unmoved; }) ||
         (motions.size () >= many_motions &&
          std::all_of (motions.begin (), motions.end (), [&] (const auto& m) { return along (m) > unmoved; }));
}

} // namespace

Motions
ObjectSymmetry::all () const
{
  return mirror ? unitedWith (*mirror, motions) : motions;
}

bool
ObjectSymmetry::tellsExtentAlong (const Eigen::Vector3d& direction) const
{
  return motions.size () >= many_motions &&
         std::any_of (motions.begin (), motions.end (), [&] (const Eigen::Affine3d& motion) {
           return (motion.linear () * direction).dot (direction) < unmoved;
         });
}

Symmetry
fittedTurn (const ProfiledShape& surface, const MeasuredShape& shape, const std::vector<OrientedPoint>& points,
            const Eigen::Vector4d& plane, bool rests, const OcclusionMap::Views& views)
{
  std::vector<OrientedPoint> held;
  std::copy_if (points.begin (), points.end (), std::back_inserter (held),
                [&] (const OrientedPoint& point) { return surface.holds (point.position.cast<double> ()); });
  const CopyJudge judge (shape, held, plane, views);
  Eigen::Vector3d axis = surface.axisDirection ().value_or (Eigen::Vector3d::Zero ());
  const Eigen::Vector3d up = plane.head<3> ();
  if (rests && std::abs (axis.dot (up)) > vertical_cosine) // what stands is vertical; its normals alone may tilt it
    axis = up;
  return givenTurn (judge, surface.center (), axis);
}

ObjectSymmetry
symmetryOf (const Observation& object, const Priors& priors, const Eigen::Vector4d& plane, bool rests,
            const std::optional<Eigen::Vector4d>& only_side, const std::vector<ProfiledShape>& round,
            const MeasuredShape& shape, const BodyEnergy& energy)
{
  const CopyJudge judge (shape, object.points (), plane, object.views);
  std::vector<Symmetry> symmetries;
  if (priors.symmetry)
    symmetries = findSymmetries (judge, energy.grid, plane);
  std::vector<Symmetry> turns;
  for (const ProfiledShape& surface : round)
    turns.push_back (fittedTurn (surface, shape, object.points (), plane, rests, object.views));
  symmetries.insert (symmetries.end (), turns.begin (), turns.end ());
  if (only_side)
    symmetries.erase (std::remove_if (symmetries.begin (), symmetries.end (),
                                      [&] (const Symmetry& s) { return copiesOntoItself (s, only_side->head<3> ()); }),
                      symmetries.end ());
  std::optional<Symmetry> symmetry = likeliest (symmetries);
  // The axis by all normals is more exact than one by a search.
  const auto turn = std::find_if (turns.begin (), turns.end (),
                                  [&] (const Symmetry& other) { return symmetry && isAsLikely (other, *symmetry); });
  if (turn != turns.end ())
    return {turn->motions, true, true, std::nullopt};
  ObjectSymmetry result;
  if (symmetry)
  {
    result.motions = symmetry->motions;
    result.is_round = std::any_of (turns.begin (), turns.end (),
                                   [&] (const Symmetry& other) { return isAboutSameAxis (other, *symmetry); });
  }
  if (priors.symmetry && rests && result.motions.size () < many_motions) // a full turn shows the foot, too
    result.mirror = findLevelMirror (judge, plane);
  return result;
}

} // namespace pcl::cosection
