// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "volume/analytic_fields.h"

#include "pcl_cosection/priors/symmetry/climb.h"
#include "pcl_cosection/priors/symmetry/level_mirror.h"
#include "pcl_cosection/priors/symmetry/object_symmetry.h"
#include "pcl_cosection/priors/symmetry/symmetry_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double step_m = 0.003; // voxels, and distances between points
const Eigen::Vector3d towards_sensor = Eigen::Vector3d (0.5, -1.0, 0.8).normalized ();

/** \brief A shape on the plane through \a origin, as a distant sensor sees it. */
struct Seen
{
  MeasuredShape shape;
  std::vector<OrientedPoint> points;
  Eigen::Vector4d plane;

  CopyJudge judge () const { return {shape, points, plane, views}; }
  std::optional<Symmetry> symmetry () const { return likeliest (findSymmetries (judge (), shape.field.grid, plane)); }

  OcclusionMap::Views views = {};
};

Seen
see (const Distance& at_origin, const Eigen::Vector3d& origin)
{
  const Distance distance = [=] (const Eigen::Vector3d& p) { return at_origin (p - origin); };
  const auto isHidden = [&] (const Eigen::Vector3d& p) {
    for (double along = step_m; along < 0.3; along += 0.5 * step_m)
      if (distance (p + along * towards_sensor) < 0.0)
        return true;
    return false;
  };
  Seen seen;
  seen.plane << 0.0, 0.0, 1.0, -origin.z ();
  seen.shape.field = sampleField (distance, 0.15, step_m);
  VoxelGrid& grid = seen.shape.field.grid;
  grid.origin_m += origin;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3d p = grid.center (i, j, k);
        const double d = distance (p);
        seen.shape.field.values[grid.index (i, j, k)] = static_cast<float> (d / step_m);
        const bool near = std::abs (d) < step_m;
        const Eigen::Vector3d lifted = near ? Eigen::Vector3d (p + (1.5 * step_m) * towards_sensor) : p;
        const bool known = d > -step_m && p.z () > origin.z () && !isHidden (lifted);
        seen.shape.known.push_back (known);
        if (!(std::abs (d) < 0.5 * step_m) || !known)
          continue;
        Eigen::Vector3d n;
        for (int a = 0; a < 3; ++a)
          n[a] = distance (p + 1e-4 * Eigen::Vector3d::Unit (a)) - distance (p - 1e-4 * Eigen::Vector3d::Unit (a));
        OrientedPoint point;
        point.position = (p - d * n.normalized ()).cast<float> ();
        point.normal = n.normalized ().cast<float> ();
        seen.points.push_back (point);
      }
  return seen;
}

Distance
standing (const Distance& shape, double height)
{
  return [=] (const Eigen::Vector3d& p) { return shape (p - Eigen::Vector3d (0.0, 0.0, 0.5 * height)); };
}

const Distance a_box = standing (
    [] (const Eigen::Vector3d& p) {
      const Eigen::Vector3d q = p.cwiseAbs () - Eigen::Vector3d (0.08, 0.05, 0.045);
      return q.cwiseMax (0.0).norm () + std::min (q.maxCoeff (), 0.0);
    },
    0.09);

const Distance a_can = standing (
    [] (const Eigen::Vector3d& p) { return std::max (p.head<2> ().norm () - 0.05, std::abs (p.z ()) - 0.06); }, 0.12);

/** \brief What lies, round at its edges above and below. */
const Distance a_tin = standing (
    [] (const Eigen::Vector3d& p) {
      const Eigen::Vector3d q = p.cwiseAbs () - Eigen::Vector3d (0.06, 0.04, 0.0);
      return q.cwiseMax (0.0).norm () + std::min (q.maxCoeff (), 0.0) - 0.025;
    },
    0.05);

/** \brief What is narrow at its top. */
const Distance a_cone = standing (
    [] (const Eigen::Vector3d& p) {
      return std::max (0.86 * p.head<2> ().norm () + 0.5 * p.z () - 0.04, std::abs (p.z ()) - 0.045);
    },
    0.09);

const Eigen::Vector3d origins[] = {Eigen::Vector3d::Zero (), {0.4, -0.3, 1.6}};

} // namespace

/** \brief Wherever it stands, the mirror planes are in its middle, to less than a voxel. */
TEST (SymmetrySearch, ABoxHasTwoMirrorPlanes)
{
  for (const Eigen::Vector3d& origin : origins)
  {
    const std::optional<Symmetry> symmetry = see (a_box, origin).symmetry ();
    ASSERT_TRUE (symmetry);
    EXPECT_EQ (symmetry->motions.size (), 3u); // two mirror planes
    ASSERT_EQ (symmetry->motions.size (), 3u);
    for (const Eigen::Affine3d& motion : symmetry->motions)
    {
      EXPECT_LE ((motion * origin - origin).norm (), 1.5 * step_m); // twice the distance from a plane
      EXPECT_LE ((motion.linear ().cwiseAbs () - Eigen::Matrix3d::Identity ()).cwiseAbs ().maxCoeff (), 0.1);
    }
  }
}

/** \brief Copies of points that noise takes outwards would be in free space, and draw the planes towards the sensor. */
TEST (SymmetrySearch, NoisyPointsHaveTheMirrorPlanesOfTheirSurface)
{
  for (const Eigen::Vector3d& origin : origins)
  {
    Seen seen = see (a_box, origin);
    const Motions exact = seen.symmetry ().value ().motions;
    for (std::size_t n = 0; n < seen.points.size (); n += 2)
      seen.points[n].position += static_cast<float> (2.5 * step_m) * seen.points[n].normal;
    const std::optional<Symmetry> symmetry = seen.symmetry ();
    ASSERT_TRUE (symmetry);
    ASSERT_EQ (symmetry->motions.size (), exact.size ());
    for (std::size_t m = 0; m < exact.size (); ++m)
      EXPECT_LE ((symmetry->motions[m] * origin - exact[m] * origin).norm (), 0.1 * step_m);
  }
}

TEST (SymmetrySearch, ACanLooksTheSameFromAllSides)
{
  for (const Eigen::Vector3d& origin : origins)
  {
    const std::optional<Symmetry> symmetry = see (a_can, origin).symmetry ();
    ASSERT_TRUE (symmetry);
    EXPECT_EQ (symmetry->motions.size (), 31u); // a full turn
    const Eigen::Vector3d on_axis = origin + Eigen::Vector3d (0.0, 0.0, 0.06);
    for (const Eigen::Affine3d& motion : symmetry->motions)
      EXPECT_LE ((motion * on_axis - on_axis).norm (), 2.0 * step_m);
  }
}

/** \brief A handle is not copied to other sides, so it does not contradict the turn of the rest. */
TEST (SymmetrySearch, AHandleDoesNotSpeakAgainstATurn)
{
  const Distance pitcher = [] (const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = (p - Eigen::Vector3d (0.075, 0.0, 0.06)).cwiseAbs () -
                              Eigen::Vector3d (0.03, 0.01, 0.045);
    return std::min (a_can (p), q.maxCoeff ());
  };
  for (const Eigen::Vector3d& origin : origins)
  {
    const Seen seen = see (pitcher, origin);
    const ProfiledShape surface (seen.points, seen.plane);
    ASSERT_TRUE (surface);
    const Symmetry turn = fittedTurn (surface, seen.shape, seen.points, seen.plane, true, seen.views);
    const Symmetry with_handle = givenTurn (seen.judge (), surface.center (), surface.axisDirection ().value ());
    EXPECT_LT (turn.evidence.contradiction, 0.5 * with_handle.evidence.contradiction);
    EXPECT_TRUE (likeliest ({turn}));
    EXPECT_FALSE (likeliest ({with_handle}));
  }
}

/** \brief What stands on a plane is not tilted by a few degrees, whatever its normals tell; what leans is, and what is
 * held. */
TEST (SymmetrySearch, AnAxisThatIsNearlyVerticalIsVertical)
{
  const auto axisOf = [] (double tilt, bool rests) {
    const Eigen::AngleAxisd turn (tilt, Eigen::Vector3d::UnitX ());
    const Eigen::Vector3d middle (0.0, 0.0, 0.06);
    const Seen seen = see ([=] (const Eigen::Vector3d& p) { return a_can (turn.inverse () * (p - middle) + middle); },
                           Eigen::Vector3d::Zero ());
    const ProfiledShape surface (seen.points); // by its normals alone
    EXPECT_TRUE (surface);
    const Symmetry turned = fittedTurn (surface, seen.shape, seen.points, seen.plane, rests, seen.views);
    return Eigen::Vector3d (Eigen::AngleAxisd (turned.motions.front ().linear ()).axis ());
  };
  EXPECT_NEAR (std::abs (axisOf (0.2, true).z ()), 1.0, 1e-6);
  EXPECT_NEAR (std::abs (axisOf (0.2, false).z ()), std::cos (0.2), 0.005);
  EXPECT_NEAR (std::abs (axisOf (0.5, true).z ()), std::cos (0.5), 0.02);
}

/** \brief Without a plane, three mirror planes tell of the hidden corner. */
TEST (SymmetrySearch, ABoxAloneHasThreeMirrorPlanes)
{
  for (const Eigen::Vector3d& origin : origins)
  {
    Seen seen = see (a_box, origin);
    seen.plane.setZero ();
    const std::optional<Symmetry> symmetry = seen.symmetry ();
    ASSERT_TRUE (symmetry);
    EXPECT_EQ (symmetry->motions.size (), 7u); // three mirror planes
    ASSERT_EQ (symmetry->motions.size (), 7u);
    const Eigen::Vector3d middle = origin + Eigen::Vector3d (0.0, 0.0, 0.045);
    for (const Eigen::Affine3d& motion : symmetry->motions)
      EXPECT_LE ((motion * middle - middle).norm (), 2.0 * step_m);
  }
}

/** \brief The lower half of a side that is visible tells whether what lies looks from below as from above. */
TEST (LevelMirror, IsConfirmedByVisibleSides)
{
  for (const Eigen::Vector3d& origin : origins)
  {
    const Seen tin = see (a_tin, origin), cone = see (a_cone, origin);
    const std::optional<Eigen::Affine3d> mirror = findLevelMirror (tin.judge (), tin.plane);
    ASSERT_TRUE (mirror);
    const Eigen::Vector3d bottom = *mirror * (origin + Eigen::Vector3d (0.01, 0.02, 0.05));
    EXPECT_LE ((bottom - origin - Eigen::Vector3d (0.01, 0.02, 0.0)).norm (), step_m);
    EXPECT_FALSE (findLevelMirror (cone.judge (), cone.plane));
  }
}

/** \brief Nothing tells it of what shows its top alone, or its sides alone. */
TEST (LevelMirror, IsNotGuessed)
{
  const auto isFound = [] (const std::function<bool (const OrientedPoint&)>& is_seen) {
    Seen seen = see (a_tin, Eigen::Vector3d::Zero ());
    seen.points.erase (std::remove_if (seen.points.begin (), seen.points.end (), std::not_fn (is_seen)),
                       seen.points.end ());
    return findLevelMirror (seen.judge (), seen.plane).has_value ();
  };
  EXPECT_TRUE (isFound ([] (const OrientedPoint&) { return true; }));
  EXPECT_FALSE (isFound ([] (const OrientedPoint& point) { return point.position.z () > 0.03f; }));
  EXPECT_FALSE (isFound ([] (const OrientedPoint& point) { return point.normal.z () < 0.7f; }));
  int count = 0;
  EXPECT_FALSE (isFound ([&] (const OrientedPoint&) { return count++ < 10; }));
}

TEST (LevelMirror, UnitesWithOtherMotions)
{
  const Eigen::Affine3d level = reflection (Eigen::Vector3d::UnitZ (), 0.1);
  const Motions motions = unitedWith (level, {reflection (Eigen::Vector3d::UnitX (), 0.0)});
  ASSERT_EQ (motions.size (), 3u);
  const Eigen::Vector3d place (0.1, 0.2, 0.0);
  EXPECT_TRUE ((motions[0] * place).isApprox (Eigen::Vector3d (-0.1, 0.2, 0.0)));
  EXPECT_TRUE ((motions[1] * place).isApprox (Eigen::Vector3d (-0.1, 0.2, 0.2)));
  EXPECT_TRUE ((motions[2] * place).isApprox (Eigen::Vector3d (0.1, 0.2, 0.2)));
}

TEST (SymmetrySearch, FewPointsHaveNone)
{
  Seen seen = see (a_box, Eigen::Vector3d::Zero ());
  seen.points.resize (10);
  EXPECT_FALSE (seen.symmetry ());
  seen.points.clear ();
  EXPECT_FALSE (seen.symmetry ());
}

/** \brief Copies support on the surface they came from, and contradict in free space and below the plane. */
TEST (CopyEvidence, OfCopiesThatAreSeenAndHidden)
{
  const Seen seen = see (a_box, Eigen::Vector3d::Zero ());
  const CopyJudge judge = seen.judge ();
  const auto shifted = [&] (const Eigen::Vector3d& by) {
    return judge.judge ({Eigen::Affine3d (Eigen::Translation3d (by))});
  };
  const CopyEvidence still = shifted (Eigen::Vector3d::Zero ());
  EXPECT_GT (still.support, 0.6);
  EXPECT_LT (still.contradiction, 0.05);
  const CopyEvidence in_front = shifted (0.1 * towards_sensor);
  EXPECT_LT (in_front.support, 0.1);
  EXPECT_GT (in_front.contradiction, 0.8);
  EXPECT_GT (shifted ({0.0, 0.0, -0.2}).contradiction, 0.99);
  const CopyEvidence hidden = shifted (-0.03 * towards_sensor);
  EXPECT_LT (hidden.contradiction, 0.5);
}

/** \brief Candidates come by falling evidence, though few of them are judged to the end. */
TEST (BestFirst, HandsOutTheSameAsJudgingAll)
{
  const Seen seen = see (a_box, Eigen::Vector3d::Zero ());
  const CopyJudge judge = seen.judge ();
  const MakeMotions motions = [] (const Parameters& p) {
    return p[1] > 0.0 ? Motions{reflection (Eigen::Vector3d (std::cos (p[0]), std::sin (p[0]), 0.0), p[2])}
                      : Motions ();
  };
  std::vector<Parameters> all;
  for (int angle = 0; angle < 12; ++angle)
    for (int offset = -5; offset <= 5; ++offset)
      all.push_back ({M_PI * angle / 12.0, angle == 3 ? -1.0 : 1.0, 0.01 * offset});
  const std::size_t stride = judge.samples ().size () / 100 + 1; // as candidates are judged
  std::vector<double> ratios;
  for (const Parameters& at : all)
    ratios.push_back (ratioOf (judge, motions (at), stride));
  std::sort (ratios.begin (), ratios.end (), std::greater<> ());
  BestFirst candidates (judge, motions, all);
  for (const double ratio : ratios)
  {
    const RatedParameters next = candidates.next ([] (const Parameters&) { return true; });
    ASSERT_FALSE (next.at.empty ());
    EXPECT_EQ (next.ratio, ratio);
    EXPECT_EQ (ratioOf (judge, motions (next.at), stride), ratio);
  }
  EXPECT_TRUE (candidates.next ([] (const Parameters&) { return true; }).at.empty ());

  BestFirst some (judge, motions, all);
  const RatedParameters wanted = some.next ([] (const Parameters& p) { return p[2] > 0.045; });
  EXPECT_GT (wanted.at[2], 0.045);
}
