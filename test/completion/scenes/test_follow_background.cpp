// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// CoSection::update () solves only the changed parts of a whole background, with the result of a fresh run.

#include "completion_scene.h"

#include <pcl/cosection/surface/co_section.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double background_voxel_m = 0.02;
constexpr double half_length_m = 1.6;
constexpr double half_width_m = 0.4;

/** \brief The difference near the surface and near data, voxels. */
double
differenceNearData (const SignedDistanceField& a, const SignedDistanceField& b)
{
  const FieldDifference difference = differenceNearSurface (a, b, true);
  EXPECT_GT (difference.voxels, 10000u);
  return difference.rms_vox;
}

void
expectSameBackground (const SceneResult& followed, const SceneResult& fresh)
{
  ASSERT_EQ (followed.background_pieces.size (), 1u);
  ASSERT_EQ (fresh.background_pieces.size (), 1u);
  const double rms = differenceNearData (*fresh.background_pieces[0].signed_distance,
                                         *followed.background_pieces[0].signed_distance);
  std::printf ("solved %.0f %%, root mean square difference %.3f voxels\n",
               100.0 * followed.background_pieces[0].solved_share, rms);
  EXPECT_LT (rms, 0.1);
}

/** \brief A long floor with five blocks on it, all of it background. */
class FollowBackground : public testing::Test
{
protected:
  FollowBackground ()
  {
    Distance all = halfSpace (Eigen::Vector4d::UnitZ ());
    for (int n = -2; n <= 2; ++n)
      all = [all, block = placed (box ({0.08, 0.06, 0.15}), Eigen::Vector3d (0.6 * n, 0.0, 0.15))] (
                const Eigen::Vector3d& p) { return std::min (all (p), block (p)); };
    scene_.add (0, all);
  }

  static CoSectionOptions options (int threads = 1)
  {
    CoSectionOptions options;
    options.whole_background = true;
    options.background_voxel_size_m = background_voxel_m;
    options.threads = threads;
    return options;
  }

  /** \brief A view from high above of the whole floor, without the sides of the blocks. */
  RenderedView fromAbove () const
  {
    return scene_.render ({320, 80, 250.0, 250.0, 159.5, 39.5},
                          lookAt ({0.0, 0.0, 2.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY ()));
  }

  /** \brief A view of a small part of the floor, from nearby. */
  RenderedView closeUp (double x, double azimuth) const
  {
    const Eigen::Vector3d target (x, 0.0, 0.1);
    const Eigen::Vector3d eye = target + Eigen::Vector3d (0.35 * std::cos (azimuth), 0.35 * std::sin (azimuth), 0.5);
    return scene_.render ({120, 90, 150.0, 150.0, 59.5, 44.5}, lookAt (eye, target), 0.8);
  }

  static std::vector<OrientedPoint> onTheFloor (const RenderedView& seen)
  {
    std::vector<OrientedPoint> points = seen.points.at (0);
    points.erase (std::remove_if (points.begin (), points.end (),
                                  [] (const OrientedPoint& p) {
                                    return std::abs (p.position.x ()) > half_length_m - background_voxel_m ||
                                           std::abs (p.position.y ()) > half_width_m - background_voxel_m;
                                  }),
                  points.end ());
    return points;
  }

  static void show (const RenderedView& seen, CoSection& task)
  {
    task.addView (seen.view);
    task.addBackground (onTheFloor (seen));
  }

  /** \brief Update, and compare with a fresh run. */
  static void expectLocalUpdate (CoSection& task)
  {
    const SceneResult followed = task.update (UpdateOutput::Fields);
    ASSERT_EQ (followed.background_pieces.size (), 1u);
    EXPECT_LT (followed.background_pieces[0].solved_share, 0.7);
    EXPECT_GT (followed.background_pieces[0].solved_share, 0.0);
    EXPECT_TRUE (followed.background_pieces[0].solver.converged ());
    expectSameBackground (followed, task.reconstruct ());
  }

  AnalyticScene scene_;
};

} // namespace

TEST_F (FollowBackground, ViewsOfPartsGiveWhatAFreshRunGives)
{
  CoSection task (options ());
  show (fromAbove (), task);
  EXPECT_EQ (task.update (UpdateOutput::Fields).background_pieces.at (0).solved_share, 1.0);
  for (const double x : {-1.2, 1.2, 0.0})
  {
    show (closeUp (x, 0.3 + x), task);
    expectLocalUpdate (task);
  }
}

TEST_F (FollowBackground, AChangeAtTheBorderOfAnEarlierOne)
{
  CoSection task (options ());
  show (fromAbove (), task);
  task.update (UpdateOutput::Fields);
  for (const double x : {0.0, 0.3, 0.6, 0.6})
  {
    show (closeUp (x, 2.0 + x), task);
    expectLocalUpdate (task);
  }
}

TEST_F (FollowBackground, GrowsNotWithEveryView)
{
  CoSection task (options ());
  const RenderedView seen = fromAbove ();
  const std::vector<OrientedPoint> all = onTheFloor (seen);
  task.addView (seen.view);
  std::vector<VoxelGrid> grids;
  SceneResult followed;
  for (const double farthest : {0.0, 0.6, 0.7, 0.8})
  {
    std::vector<OrientedPoint> part;
    std::copy_if (all.begin (), all.end (), std::back_inserter (part),
                  [&] (const OrientedPoint& p) { return p.position.x () < farthest; });
    task.addBackground (part);
    followed = task.update (UpdateOutput::Fields);
    grids.push_back (followed.background_pieces.at (0).signed_distance->grid);
  }
  EXPECT_GT (grids[1].dims.x (), grids[0].dims.x ());
  EXPECT_EQ (grids[2].dims, grids[1].dims);
  EXPECT_EQ (grids[3].dims, grids[1].dims);
  EXPECT_EQ (grids[1].dims.tail<2> (), grids[0].dims.tail<2> ());
  expectSameBackground (followed, task.reconstruct ());
}

/** \brief A view without points removes the surface of a ghost that it looks through. */
TEST_F (FollowBackground, FreeSpaceChangesAndNoPoints)
{
  CoSection task (options ());
  task.addBackground (onTheFloor (fromAbove ()));
  const Eigen::Vector3d center (0.3, 0.0, 0.14);
  std::vector<OrientedPoint> ghost;
  for (int n = 0; n < 2000; ++n)
  {
    const double z = 1.0 - (2 * n + 1) / 2000.0;
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d normal (r * std::cos (2.4 * n), r * std::sin (2.4 * n), z);
    ghost.push_back ({(center + 0.05 * normal).cast<float> (), normal.cast<float> ()});
  }
  task.addBackground (ghost);
  const SignedDistanceField before = *task.update (UpdateOutput::Fields).background_pieces.at (0).signed_distance;
  EXPECT_LT (*before.sample (center), 0.0);
  task.addView (closeUp (0.3, 0.5).view);
  expectLocalUpdate (task);
  EXPECT_GT (*task.update (UpdateOutput::Fields).background_pieces.at (0).signed_distance->sample (center), 0.0);
}

TEST_F (FollowBackground, AViewIsGivenUp)
{
  CoSection task (options ());
  show (fromAbove (), task);
  show (closeUp (-0.6, 1.0), task);
  show (closeUp (0.6, 2.0), task);
  task.update (UpdateOutput::Fields);
  task.removeViews ({false, true, false});
  expectLocalUpdate (task);
}

TEST_F (FollowBackground, NothingNewChangesNothing)
{
  CoSection task (options ());
  show (fromAbove (), task);
  show (closeUp (0.0, 1.0), task);
  const SceneResult before = task.update (UpdateOutput::Fields);
  const SceneResult after = task.update (UpdateOutput::Fields);
  EXPECT_LT (after.background_pieces.at (0).solved_share, 0.2);
  EXPECT_LT (differenceNearData (*before.background_pieces.at (0).signed_distance,
                                 *after.background_pieces[0].signed_distance),
             0.01);
}

TEST_F (FollowBackground, ErrorsOfManyUpdatesDoNotAddUp)
{
  CoSection task (options ());
  show (fromAbove (), task);
  task.update (UpdateOutput::Fields);
  for (int n = 0; n < 30; ++n)
  {
    show (closeUp (-1.4 + 2.8 * (n * 7 % 30) / 29.0, 1.7 * n), task);
    if (n % 10 == 9)
      expectLocalUpdate (task);
    else
      task.update (UpdateOutput::Fields);
  }
}

TEST_F (FollowBackground, IsTheSameForAnyNumberOfThreads)
{
  std::vector<float> values;
  for (const int threads : {1, 3})
  {
    CoSection task (options (threads));
    show (fromAbove (), task);
    task.update (UpdateOutput::Fields);
    show (closeUp (-0.5, 1.0), task);
    task.update (UpdateOutput::Fields);
    show (closeUp (0.7, 2.0), task);
    const SceneResult result = task.update (UpdateOutput::Fields);
    if (threads == 1)
      values = result.background_pieces.at (0).signed_distance->values;
    else
      EXPECT_EQ (values, result.background_pieces.at (0).signed_distance->values);
  }
}
