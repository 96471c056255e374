// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Walls of things behind others continue down to the support plane.

#include "completion/lowest_vertex.h"
#include "completion/scenes/completion_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int thing = 1, screen = 2;
constexpr double reaches_table_vox = 1.5;

/** \brief A round thing that stands on z = 0; wider at the bottom by \a lean times its height. */
Distance
standingCan (double radius, double height, double lean = 0.0)
{
  return [=] (const Eigen::Vector3d& p) {
    const double across = (p.head<2> ().norm () - radius - lean * (height - p.z ())) / std::hypot (1.0, lean);
    return std::max ({across, -p.z (), p.z () - height});
  };
}

/** \brief A prism with a triangle as its outline. */
Distance
wedge (double along, double across, double height)
{
  const Eigen::Vector2d out = Eigen::Vector2d (1.0 / along, 1.0 / across).normalized ();
  return [=] (const Eigen::Vector3d& p) {
    const double slope = out.dot (p.head<2> () - Eigen::Vector2d (along, 0.0));
    return std::max ({slope, -p.x (), -p.y (), -p.z (), p.z () - height});
  };
}

/** \brief A thing on a table, and a board before it. */
class HiddenWalls : public testing::Test
{
protected:
  /** \param[in] board lower left and upper right corner, as the camera sees it; x and z */
  void see (const Distance& shape, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double voxel = voxel_m)
  {
    scene_.add (0, halfSpace (table_plane));
    scene_.add (thing, shape);
    const Eigen::Vector2d middle = 0.5 * (low + high), half = 0.5 * (high - low);
    scene_.add (screen, placed (box ({half.x (), 0.01, half.y ()}), Eigen::Vector3d (middle.x (), -0.16, middle.y ())));
    seen_ = scene_.render (tableCamera (), lookAt ({0.0, -0.75, 0.38}, {0.0, 0.0, 0.05}));
    result_ = complete (seen_, optionsFor (voxel));
    ASSERT_EQ (mesh ().empty (), false) << result_.objects.at (0).error;
    EXPECT_TRUE (computeTopology (mesh ()).closed_manifold);
  }

  float lowestSeen () const
  {
    float least = 1.0f;
    for (const OrientedPoint& p : seen_.points.at (thing))
      least = std::min (least, p.position.z ());
    return least;
  }

  const TriangleMesh& mesh () const { return result_.objects.at (0).mesh; }

  double litres () const { return 1e3 * computeMassProperties (mesh ()).volume_m3; }

  void expectToStand () const { EXPECT_LT (lowest (mesh ()), reaches_table_vox * voxel_m); }

  AnalyticScene scene_;
  RenderedView seen_;
  SceneResult result_;
};

} // namespace

TEST_F (HiddenWalls, OfABoxReachTheTable)
{
  Eigen::Isometry3d pose (Eigen::AngleAxisd (0.5, Eigen::Vector3d::UnitZ ()));
  pose.pretranslate (Eigen::Vector3d (0.0, 0.0, 0.09));
  see (placed (box ({0.06, 0.045, 0.09}), pose), {-0.15, 0.0}, {0.15, 0.12});
  ASSERT_GT (lowestSeen (), 0.05f);
  expectToStand ();
  EXPECT_NEAR (litres (), 8e3 * 0.06 * 0.045 * 0.09, 0.1 * 8e3 * 0.06 * 0.045 * 0.09);
}

TEST_F (HiddenWalls, OfABoxGoOnBesideWhatWasSeenOfThem)
{
  Eigen::Isometry3d pose (Eigen::AngleAxisd (0.5, Eigen::Vector3d::UnitZ ()));
  pose.pretranslate (Eigen::Vector3d (0.0, 0.0, 0.035));
  see (placed (box ({0.08, 0.035, 0.035}), pose), {-0.02, 0.0}, {0.12, 0.115});
  expectToStand ();
  EXPECT_NEAR (litres (), 8e3 * 0.08 * 0.035 * 0.035, 0.1 * 8e3 * 0.08 * 0.035 * 0.035);
}

TEST_F (HiddenWalls, OfAWedgeAreNoCopies)
{
  see (placed (wedge (0.13, 0.1, 0.12), Eigen::Vector3d (-0.06, -0.05, 0.0)), {-0.15, 0.0}, {0.15, 0.11});
  expectToStand ();
  const double truth = 0.5e3 * 0.13 * 0.1 * 0.12;
  EXPECT_NEAR (litres (), truth, 0.15 * truth);
}

/** \brief What is round at its edges above and on its visible side is so below, too: no wall reaches the table. */
TEST_F (HiddenWalls, OfWhatLooksFromBelowAsFromAboveEndAboveTheTable)
{
  constexpr double radius = 0.025;
  const Eigen::Vector3d half (0.06, 0.04, radius);
  const Distance flat = box ({half.x (), half.y (), 1e-4});
  const Distance tin = [&] (const Eigen::Vector3d& p) { return flat (p) - radius; };
  scene_.add (0, halfSpace (table_plane));
  scene_.add (thing, placed (tin, Eigen::Vector3d (0.0, 0.0, radius)));
  seen_ = scene_.render (tableCamera (), lookAt ({0.1, -0.5, 0.4}, {0.0, 0.0, 0.03}));
  const auto errorBelow = [&] (const CoSectionOptions& options) {
    double sum = 0.0, count = 0.0;
    const TriangleMesh mesh = complete (seen_, options).objects.at (0).mesh;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      if (vertex.z () < radius)
      {
        sum += std::abs (tin (vertex.cast<double> () - Eigen::Vector3d (0.0, 0.0, radius)));
        count += 1.0;
      }
    return sum / count;
  };
  CoSectionOptions options = optionsFor (0.0025);
  const double with = errorBelow (options);
  options.priors.symmetry = false;
  EXPECT_LT (with, 0.4 * errorBelow (options));
}

/** \brief The enclosed space is solid, although it is as far from observed surface as the can is high. */
TEST_F (HiddenWalls, OfACanAreNoTube)
{
  constexpr double radius = 0.05, height = 0.11;
  see (standingCan (radius, height), {-0.15, 0.0}, {0.15, 0.141}, 0.0025);
  ASSERT_GT (lowestSeen (), 0.08f);
  expectToStand ();
  const double truth = 1e3 * M_PI * radius * radius * height;
  EXPECT_NEAR (litres (), truth, 0.1 * truth);
}

/** \brief The space below the free space beside a top is empty. */
TEST_F (HiddenWalls, OfAnLFollowItsNotch)
{
  const Distance along = placed (box ({0.08, 0.03, 0.04}), Eigen::Vector3d (0.0, -0.05, 0.04));
  const Distance across = placed (box ({0.03, 0.08, 0.04}), Eigen::Vector3d (-0.05, 0.0, 0.04));
  see ([=] (const Eigen::Vector3d& p) { return std::min (along (p), across (p)); }, {-0.02, 0.0}, {0.02, 0.02});
  const double truth = 8e3 * 0.04 * (0.08 * 0.03 + 0.03 * 0.05);
  EXPECT_NEAR (litres (), truth, 0.2 * truth); // without that 1.28
}

/** \brief The lower top goes on behind what stands on it: the free space over it is beside the upper one only. */
TEST_F (HiddenWalls, BelowALowerTopAreFilled)
{
  Eigen::Isometry3d pose (Eigen::AngleAxisd (0.3, Eigen::Vector3d::UnitZ ()));
  const Distance lower = placed (box ({0.08, 0.06, 0.05}), Eigen::Vector3d (0.0, 0.0, 0.05));
  const Distance upper = placed (box ({0.04, 0.03, 0.025}), Eigen::Vector3d (-0.02, -0.02, 0.125));
  see (placed ([=] (const Eigen::Vector3d& p) { return std::min (lower (p), upper (p)); }, pose), {-0.02, 0.0},
       {0.02, 0.02}, 0.004);
  const double truth = 8e3 * (0.08 * 0.06 * 0.05 + 0.04 * 0.03 * 0.025);
  EXPECT_NEAR (litres (), truth, 0.1 * truth); // with the lower top as a wall's 0.83
}

TEST_F (HiddenWalls, OfACanReachTheTable)
{
  see (standingCan (0.05, 0.18), {-0.15, 0.0}, {0.15, 0.12});
  ASSERT_GT (lowestSeen (), 0.05f);
  expectToStand ();
  const double truth = 1e3 * M_PI * 0.05 * 0.05 * 0.18;
  EXPECT_NEAR (litres (), truth, 0.1 * truth);
}

TEST_F (HiddenWalls, LeanAsTheyLeanWhereTheyWereSeen)
{
  see (standingCan (0.035, 0.18, 0.15), {-0.15, 0.0}, {0.15, 0.11});
  ASSERT_GT (lowestSeen (), 0.04f);
  expectToStand ();
  const double a = 0.035, b = 0.035 + 0.15 * 0.18;
  const double truth = 1e3 * M_PI / 3.0 * 0.18 * (a * a + a * b + b * b);
  EXPECT_NEAR (litres (), truth, 0.12 * truth);
}

/** \brief Something nearer hides one end of a long box: it goes on half of the way that is hidden. */
TEST_F (HiddenWalls, GoOnBehindWhatIsNearer)
{
  const auto farthest = [] (const TriangleMesh& mesh) {
    float most = -1.0f;
    for (const Eigen::Vector3f& p : mesh.vertices)
      most = std::max (most, p.x ());
    return most;
  };
  see (placed (box ({0.12, 0.025, 0.025}), Eigen::Vector3d (0.0, 0.0, 0.025)), {0.03, 0.0}, {0.2, 0.13});
  EXPECT_NEAR (farthest (mesh ()), 0.12f, 0.03f);
  CoSectionOptions options = optionsFor (voxel_m);
  options.priors.extrusion = false;
  EXPECT_LT (farthest (complete (seen_, options).objects.at (0).mesh), 0.08f);
}

/** \brief What copies by mirror planes fill does not go on elsewhere. */
TEST_F (HiddenWalls, OfABoxAreCopiedWhereACornerIsHidden)
{
  Eigen::Isometry3d pose (Eigen::AngleAxisd (0.6, Eigen::Vector3d::UnitZ ()));
  pose.pretranslate (Eigen::Vector3d (0.0, 0.0, 0.02));
  see (placed (box ({0.11, 0.08, 0.02}), pose), {0.06, 0.0}, {0.2, 0.14}, 0.003);
  const double truth = 8e3 * 0.11 * 0.08 * 0.02;
  EXPECT_NEAR (litres (), truth, 0.06 * truth);
}

/** \brief Seen on both sides of what hides its middle, a face goes on. */
TEST_F (HiddenWalls, GoOnToWhereTheyAreSeenAgain)
{
  see (placed (box ({0.12, 0.025, 0.025}), Eigen::Vector3d (0.0, 0.0, 0.025)), {-0.03, 0.0}, {0.03, 0.13}, 0.0025);
  const double truth = 8e3 * 0.12 * 0.025 * 0.025;
  EXPECT_NEAR (litres (), truth, 0.1 * truth);
}

/** \brief From straight above only its top shows how far a box reaches down: to the table. */
TEST_F (HiddenWalls, OfABoxSeenFromAboveReachTheTable)
{
  scene_.add (0, halfSpace (table_plane));
  scene_.add (thing, placed (box ({0.05, 0.035, 0.07}), Eigen::Vector3d (0.0, 0.0, 0.07)));
  const Eigen::Isometry3d above = lookAt ({0.0, -0.02, 0.85}, {0.0, 0.0, 0.05});
  result_ = complete (scene_.render (tableCamera (), above), optionsFor (0.0025));
  expectToStand ();
  const double truth = 8e3 * 0.05 * 0.035 * 0.07;
  EXPECT_NEAR (litres (), truth, 0.2 * truth); // readings at the edges of its top are left out
}

/** \brief Behind the board is the edge of a shelf, not a standing thing: the table is visible below it. */
TEST_F (HiddenWalls, EndWhereTheTableIsSeenBelow)
{
  see (placed (box ({0.06, 0.045, 0.03}), Eigen::Vector3d (0.0, 0.0, 0.2)), {-0.15, 0.155}, {0.15, 0.175});
  EXPECT_GT (lowest (mesh ()), 0.12f);
}
