// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "free_space_scene.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>

// The points that FreeSpaceFilter removes and keeps.

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Filter = FreeSpaceFilter<pcl::PointXYZ>;

/** \brief Distance to the nearest surface; negative inside. */
double
clearance (const AnalyticScene& scene, const Eigen::Vector3d& p)
{
  return std::min ({scene.shape (0) (p), scene.shape (1) (p), scene.shape (2) (p)});
}

/** \brief How many of \a passed are below \a limit. */
std::size_t
countBelow (const pcl::Indices& passed, std::size_t limit)
{
  return std::count_if (passed.begin (), passed.end (), [&] (auto i) { return static_cast<std::size_t> (i) < limit; });
}

class FreeSpaceFilterTest : public testing::TestWithParam<double> // noise
{
protected:
  const std::vector<DepthView> views_ = renderTable (tableScene (), GetParam ());
  const Points::Ptr surface_ = merged (views_);
};

} // namespace

TEST_P (FreeSpaceFilterTest, RemovesGhostsAndNothingElse)
{
  const std::size_t surface = surface_->size ();
  auto cloud = pcl::make_shared<Points> (*surface_ + ghosts ());
  Filter filter;
  addViews (views_, filter);
  const pcl::Indices passed = passing (filter, cloud);
  const std::size_t kept = countBelow (passed, surface);
  EXPECT_EQ (kept, passed.size ()) << "ghosts that are left";
  const std::size_t allowed = GetParam () > 0.0 ? surface / 10000 : 0;
  EXPECT_LE (surface - kept, allowed) << "of " << surface;
  EXPECT_GT (surface, 50000u);
}

/** \brief A surface stays also without the vote of its own view, as the others do not look through it. */
TEST_P (FreeSpaceFilterTest, OtherViewsDoNotContradictASurface)
{
  std::size_t kept = 0, all = 0;
  for (std::size_t own = 0; own < views_.size (); ++own)
  {
    const Points::Ptr cloud = merged ({views_[own]});
    Filter filter;
    for (std::size_t other = 0; other < views_.size (); ++other)
      if (other != own)
        filter.addView (views_[other]);
    kept += passing (filter, cloud).size ();
    all += cloud->size ();
  }
  EXPECT_GE (static_cast<double> (kept), (GetParam () > 0.0 ? 0.999 : 1.0) * all) << all - kept << " of " << all;
}

TEST_P (FreeSpaceFilterTest, ASingleViewDoesNotContradictItself)
{
  Filter filter;
  filter.addView (views_.front ());
  const Points::Ptr own = merged ({views_.front ()});
  EXPECT_EQ (passing (filter, own).size (), own->size ());
}

/** \brief At 80 degrees from the normal a millimetre above the surface is six along the ray. */
TEST_P (FreeSpaceFilterTest, AGrazingViewDoesNotContradictNoise)
{
  const Eigen::Vector3d middle (0.0, 0.0, 0.0);
  AnalyticScene table;
  table.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  const std::vector<Eigen::Isometry3d> poses{lookAt ({0.0, -0.3, 0.6}, middle), lookAt ({0.7, 0.0, 0.12}, middle),
                                             lookAt ({-0.7, 0.0, 0.12}, middle)};
  const std::vector<DepthView> views = renderTable (table, GetParam (), poses);
  const Points::Ptr cloud = merged ({views.front ()});
  Filter filter;
  filter.addView (views[1]);
  filter.addView (views[2]);
  const std::size_t kept = passing (filter, cloud).size ();
  EXPECT_GE (static_cast<double> (kept), (GetParam () > 0.0 ? 0.999 : 1.0) * cloud->size ());
}

/** \brief Random points: removed points are in free space, and points in free space in all views are removed. */
TEST_P (FreeSpaceFilterTest, RemovesWhatIsInTheOpen)
{
  const AnalyticScene scene = tableScene ();
  auto cloud = pcl::make_shared<Points> ();
  std::mt19937 generator (3);
  std::uniform_real_distribution<float> across (-0.2f, 0.2f), up (-0.05f, 0.25f);
  for (int i = 0; i < 20000; ++i)
    cloud->push_back ({across (generator), across (generator), up (generator)});
  Filter filter (true);
  addViews (views_, filter);
  const pcl::Indices passed = passing (filter, cloud);
  double nearest = 1.0;
  for (const auto i : *filter.getRemovedIndices ())
    nearest = std::min (nearest, clearance (scene, (*cloud)[i].getVector3fMap ().cast<double> ()));
  // Noise of nearly 1.5 mm at this range can eat into the margin of 5 mm.
  EXPECT_GT (nearest, GetParam () > 0.0 ? 0.001 : 0.004);

  // Higher than everything: no view is blocked there, though a line to a sensor may end at an edge.
  std::size_t high = 0, high_kept = 0;
  const auto is_high = [&] (auto i) { return (*cloud)[i].z > 0.2f; };
  for (std::size_t i = 0; i < cloud->size (); ++i)
    high += is_high (i);
  high_kept = std::count_if (passed.begin (), passed.end (), is_high);
  EXPECT_GT (high, 2000u);
  EXPECT_EQ (high_kept, 0u) << "of " << high;
}

INSTANTIATE_TEST_SUITE_P (Noise, FreeSpaceFilterTest, testing::Values (0.0, 1.0));

/** \brief Mixed pixels, with depths between those of an object and of the surface behind it. */
TEST (FreeSpaceFilter, RemovesFlyingPixelsThatOtherViewsSeeThrough)
{
  const AnalyticScene scene = tableScene ();
  std::vector<DepthView> views = renderTable (scene);
  DepthView& view = views.front ();
  const std::vector<float> right = view.depth;
  std::mt19937 generator (5);
  std::uniform_real_distribution<float> share (0.3f, 0.7f);
  auto flying = pcl::make_shared<Points> ();
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u + 1 < view.camera.width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * view.camera.width + u;
      if (!(std::abs (right[n] - right[n + 1]) > 0.08f))
        continue;
      const float s = share (generator);
      view.depth[n] = s * right[n] + (1.0f - s) * right[n + 1];
      const Eigen::Vector3d p = view.T_world_sensor * view.camera.unproject (u, v, view.depth[n]);
      if (clearance (scene, p) > 0.02)
        flying->emplace_back (p.x (), p.y (), p.z ());
    }
  ASSERT_GT (flying->size (), 30u);
  Filter filter;
  addViews (views, filter);
  const std::size_t left = passing (filter, flying).size ();
  EXPECT_LE (left, flying->size () / 20) << "of " << flying->size (); // those beside depth edges in all other views
  const Points::Ptr surface = merged (renderTable (scene));
  EXPECT_EQ (passing (filter, surface).size (), surface->size ());
}

TEST (FreeSpaceFilter, AViewWithAWrongPoseLosesToTwoRightOnes)
{
  std::vector<DepthView> views = renderTable (tableScene (), 1.0);
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity ();
  wrong.translation () = Eigen::Vector3d (0.0, 0.0, 0.03); // its table floats
  views.back ().T_world_sensor = wrong * views.back ().T_world_sensor;
  const Points::Ptr right_points = merged ({views[0], views[1]});
  const Points::Ptr wrong_points = merged ({views[2]});
  Filter filter;
  addViews (views, filter);
  const std::size_t right_kept = passing (filter, right_points).size ();
  EXPECT_GT (static_cast<double> (right_kept), 0.99 * right_points->size ());

  // Where both correct views see the table, the floating one is removed.
  std::size_t near_middle = 0, near_middle_kept = 0;
  const auto in_the_open = [&] (const pcl::PointXYZ& p) {
    return std::abs (p.z - 0.03f) < 0.01f && p.x < 0.0f && p.y < -0.12f && std::hypot (p.x, p.y) < 0.2f;
  };
  near_middle = std::count_if (wrong_points->begin (), wrong_points->end (), in_the_open);
  for (const auto i : passing (filter, wrong_points))
    near_middle_kept += in_the_open ((*wrong_points)[i]);
  EXPECT_GT (near_middle, 80u);
  EXPECT_LT (near_middle_kept, near_middle / 100) << "of " << near_middle;
}

TEST (FreeSpaceFilter, CountsVotes)
{
  AnalyticScene moved; // the ball was taken away
  moved.add (0, tableScene ().shape (0));
  moved.add (2, tableScene ().shape (2));
  const std::vector<Eigen::Isometry3d> pose{tablePoses ().front ()};
  const DepthView with = renderTable (tableScene (), 0.0, pose).front ();
  const DepthView without = renderTable (moved, 0.0, pose).front ();
  const Eigen::Vector3d eye = pose.front ().translation ();
  const Eigen::Vector3d centre (-0.08, 0.0, 0.06);
  const Eigen::Vector3f front = (centre + 0.06 * (eye - centre).normalized ()).cast<float> ();
  auto cloud = pcl::make_shared<Points> ();
  cloud->push_back ({front.x (), front.y (), front.z ()});
  const auto passes = [&] (const std::vector<DepthView>& views, int minimum) {
    Filter filter;
    addViews (views, filter);
    filter.setMinimumViews (minimum);
    return passing (filter, cloud).size () == 1;
  };
  EXPECT_TRUE (passes ({with}, 1));
  EXPECT_FALSE (passes ({without}, 1));
  EXPECT_TRUE (passes ({with, without}, 1)) << "a tie removes nothing";
  EXPECT_FALSE (passes ({without, with, without}, 1));
  EXPECT_TRUE (passes ({without}, 2));
  EXPECT_FALSE (passes ({without, without}, 2));
  EXPECT_TRUE (passes ({with, with, without, without}, 2));
}

TEST (FreeSpaceFilter, MarginIsWhatItSays)
{
  AnalyticScene wall;
  wall.add (0, halfSpace ({0.0, 0.0, -1.0, 1.0})); // one metre in front of the sensor
  const DepthView view = wall.render (smallCamera (), Eigen::Isometry3d::Identity ()).view;
  auto cloud = pcl::make_shared<Points> ();
  for (int i = 0; i < 1000; ++i)
    cloud->push_back ({0.0f, 0.0f, 1.0f - 0.0001f * (i + 0.5f)}); // every tenth of a millimetre
  const auto kept = [&] (float margin) {
    Filter filter;
    filter.addView (view);
    filter.setMargin (margin);
    return static_cast<double> (passing (filter, cloud).size ());
  };
  EXPECT_NEAR (kept (0.02f), 200.0, 1.0);
  EXPECT_NEAR (kept (0.05f), 500.0, 1.0);
  EXPECT_NEAR (kept (0.0f), 10000.0 * std::max (0.005, 3.0 * depthNoiseSigma (1.0)), 1.0);
}

TEST (FreeSpaceFilter, MissingReadingsSayNothing)
{
  std::vector<DepthView> views = renderTable (tableScene ());
  for (DepthView& view : views)
    for (std::size_t n = 0; n < view.depth.size (); ++n)
      view.depth[n] = n % 3 == 0 ? not_a_number : n % 3 == 1 ? 0.0f : std::numeric_limits<float>::infinity ();
  Filter filter;
  addViews (views, filter);
  const auto cloud = pcl::make_shared<Points> (ghosts ());
  EXPECT_EQ (passing (filter, cloud).size (), cloud->size ());
}

TEST (FreeSpaceFilter, IsTheSameForAnyNumberOfThreadsAndAnyWayToGiveAView)
{
  const std::vector<DepthView> views = renderTable (tableScene (), 1.0);
  const auto cloud = pcl::make_shared<Points> (*merged (views) + ghosts ());
  Filter one, three, of_clouds;
  addViews (views, one);
  addViews (views, three);
  for (const DepthView& view : views)
    EXPECT_TRUE (of_clouds.addView (toCloud (view, false), view.T_world_sensor));
  one.setNumberOfThreads (1);
  three.setNumberOfThreads (3);
  const pcl::Indices expected = passing (one, cloud);
  EXPECT_EQ (passing (three, cloud), expected);
  EXPECT_EQ (passing (of_clouds, cloud), expected);
}

/** \brief Views and points turn together. */
TEST (FreeSpaceFilter, FollowsThePose)
{
  std::vector<DepthView> views = renderTable (tableScene (), 1.0);
  const auto cloud = pcl::make_shared<Points> (*merged (views) + ghosts ());
  Filter straight, turned;
  addViews (views, straight);
  const Eigen::Isometry3d T = Eigen::Translation3d (0.3, -0.2, 0.5) *
                              Eigen::AngleAxisd (1.2, Eigen::Vector3d (1.0, -2.0, 0.5).normalized ());
  for (DepthView& view : views)
    view.T_world_sensor = T * view.T_world_sensor;
  addViews (views, turned);
  auto turned_cloud = pcl::make_shared<Points> ();
  for (const auto& p : *cloud)
  {
    const Eigen::Vector3f q = (T * p.getVector3fMap ().cast<double> ()).cast<float> ();
    turned_cloud->push_back ({q.x (), q.y (), q.z ()});
  }
  const double a = static_cast<double> (passing (straight, cloud).size ());
  const double b = static_cast<double> (passing (turned, turned_cloud).size ());
  EXPECT_NEAR (a, b, 3.0); // rounding may move a point across a margin
  EXPECT_LT (a, cloud->size () - 499.0);
}
