// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "completion/analytic_scene.h"

#include "pcl_cosection/energy/constraints/hull_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double wall_m = 1.0;
constexpr double ball_m = 0.6; // distance of the ball's centre
constexpr double ball_radius_m = 0.08;

/** \brief A wall across the view and a ball in front of it; the sensor at the origin. */
AnalyticScene
ballBeforeWall ()
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, -1.0, wall_m}));
  scene.add (1, placed (sphere (ball_radius_m), Eigen::Vector3d (0.0, 0.0, ball_m)));
  return scene;
}

AnalyticScene
wallOnly ()
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, -1.0, wall_m}));
  return scene;
}

DepthView
rendered (const AnalyticScene& scene)
{
  return scene.render (smallCamera (), Eigen::Isometry3d::Identity ()).view;
}

/** \brief A grid of a given number of voxels along each axis about a point. */
VoxelGrid
gridAbout (const Eigen::Vector3d& centre, int size, double voxel_size_m)
{
  VoxelGrid grid;
  grid.dims.setConstant (size);
  grid.voxel_size_m = voxel_size_m;
  grid.origin_m = centre - Eigen::Vector3d::Constant (0.5 * voxel_size_m * (size - 1));
  return grid;
}

std::vector<std::uint8_t>
freeSpace (const VoxelGrid& grid, const std::vector<DepthView>& views, bool revise = true, int threads = 1)
{
  HullConstraint hull (grid, threads);
  for (const DepthView& view : views)
    hull.add (FreeSpaceView (view), view.T_world_sensor);
  return hull.freeSpace (revise);
}

/** \brief Range of the readings within some pixels of a point's projection. */
struct Footprint
{
  double nearest = std::numeric_limits<double>::infinity ();
  double farthest = 0.0;
  bool complete = true; ///< inside the image, without missing readings and depth edges
};

Footprint
footprint (const FreeSpaceView& view, const Eigen::Vector3d& p, int radius)
{
  Footprint out;
  const PinholeCamera& camera = view.view ().camera;
  const Eigen::Vector2i at = (camera.project (p).array () + 0.5).floor ().cast<int> ();
  for (int v = at.y () - radius; v <= at.y () + radius; ++v)
    for (int u = at.x () - radius; u <= at.x () + radius; ++u)
    {
      if (u < 0 || v < 0 || u >= camera.width || v >= camera.height || !std::isfinite (view.view ().at (u, v)))
      {
        out.complete = false;
        continue;
      }
      out.complete &= !view.atEdge (u, v);
      out.nearest = std::min (out.nearest, static_cast<double> (view.view ().at (u, v)));
      out.farthest = std::max (out.farthest, static_cast<double> (view.view ().at (u, v)));
    }
  return out;
}

double
margin (const VoxelGrid& grid, double depth)
{
  return std::max (3.0 * grid.voxel_size_m, 3.0 * depthNoiseSigma (depth));
}

class HullConstraintTest : public testing::TestWithParam<double> // voxel size
{
protected:
  const VoxelGrid grid_ = gridAbout ({0.0, 0.0, ball_m}, 41, GetParam ());
  const VoxelGrid rim_ = gridAbout ({ball_radius_m, 0.0, ball_m}, 41, GetParam ()); ///< about the silhouette
};

} // namespace

/** \brief The margin is three voxels or three standard deviations, whichever is larger. */
TEST_P (HullConstraintTest, EndsAtTheMarginBeforeAWall)
{
  const VoxelGrid grid = gridAbout ({0.0, 0.0, wall_m}, 41, GetParam ());
  const std::vector<std::uint8_t> free_space = freeSpace (grid, {rendered (wallOnly ())});
  const double m = margin (grid, wall_m);
  std::size_t checked = 0, wrong = 0;
  forEachVoxel (grid, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const double gap = wall_m - p.z ();
    if (std::abs (gap - m) < 1e-5)
      return;
    ++checked;
    wrong += (free_space[n] != 0) != (gap > m);
  });
  EXPECT_EQ (wrong, 0u);
  EXPECT_GT (checked, grid.size () / 2);
}

TEST_P (HullConstraintTest, NeverFreesABody)
{
  const AnalyticScene scene = ballBeforeWall ();
  const std::vector<std::uint8_t> free_space = freeSpace (grid_, {rendered (scene)});
  std::size_t hidden = 0, wrong = 0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const bool behind = p.z () > ball_m && p.head<2> ().norm () < ball_radius_m;
    if (scene.shape (1) (p) >= 0.0 && !behind && p.z () <= wall_m)
      return;
    ++hidden;
    wrong += free_space[n] != 0;
  });
  EXPECT_EQ (wrong, 0u);
  EXPECT_GT (hidden, 1000u);
}

/** \brief A voxel is free only if all readings in its footprint are farther, and always if all around are. */
TEST_P (HullConstraintTest, FollowsTheFootprint)
{
  const FreeSpaceView view (rendered (ballBeforeWall ()));
  const std::vector<std::uint8_t> free_space = freeSpace (rim_, {view.view ()});
  std::size_t free_voxels = 0, wrongly_free = 0, clear = 0, wrongly_hull = 0;
  forEachVoxel (rim_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const int radius = static_cast<int> (
        std::ceil (0.5 * std::sqrt (3.0) * rim_.voxel_size_m * smallCamera ().fx / p.z ()));
    const Footprint own = footprint (view, p, radius);
    free_voxels += free_space[n] != 0;
    wrongly_free += free_space[n] && own.nearest - p.z () < margin (rim_, own.nearest) - 1e-6;
    // The footprint in use may be that of the nearest voxel.
    const Footprint wide = footprint (view, p, 2 * radius + 1);
    const bool is_clear = wide.complete && wide.nearest - p.z () > margin (rim_, wide.farthest);
    clear += is_clear;
    wrongly_hull += is_clear && !free_space[n];
  });
  EXPECT_EQ (wrongly_free, 0u);
  EXPECT_EQ (wrongly_hull, 0u);
  EXPECT_GT (free_voxels, 1000u);
  EXPECT_GT (clear, 1000u);
}

TEST_P (HullConstraintTest, SaysNothingWhereDepthIsMissing)
{
  DepthView view = rendered (wallOnly ());
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
      if (u < 80)
        view.depth[static_cast<std::size_t> (v) * view.camera.width + u] = not_a_number;
  const std::vector<std::uint8_t> free_space = freeSpace (grid_, {view});
  std::size_t left = 0, wrong = 0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const Eigen::Vector2d pixel = view.camera.project (p);
    const bool in_image = std::abs (pixel.x () - 79.5) < 79.0 && std::abs (pixel.y () - 59.5) < 59.0;
    if (!in_image || std::abs (pixel.x () - 79.5) < 0.01)
      return;
    left += pixel.x () < 79.5;
    wrong += (free_space[n] != 0) != (pixel.x () > 79.5);
  });
  EXPECT_EQ (wrong, 0u);
  EXPECT_GT (left, 1000u);
}

TEST_P (HullConstraintTest, SaysNothingAtDepthEdges)
{
  const FreeSpaceView view (rendered (ballBeforeWall ()));
  const PinholeCamera& camera = view.view ().camera;
  const std::vector<std::uint8_t> free_space = freeSpace (rim_, {view.view ()});
  std::size_t at_edge = 0, wrong = 0;
  forEachVoxel (rim_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const Eigen::Vector2i pixel = (camera.project (p).array () + 0.5).floor ().cast<int> ();
    const bool in_image = pixel.x () >= 0 && pixel.y () >= 0 && pixel.x () < camera.width && pixel.y () < camera.height;
    if (!in_image || !view.atEdge (pixel.x (), pixel.y ()))
      return;
    ++at_edge;
    wrong += free_space[n] != 0;
  });
  EXPECT_EQ (wrong, 0u);
  EXPECT_GT (at_edge, 100u);
}

TEST_P (HullConstraintTest, IsTheSameForAnyNumberOfThreads)
{
  const std::vector<DepthView> views{rendered (ballBeforeWall ())};
  EXPECT_EQ (freeSpace (grid_, views, true, 1), freeSpace (grid_, views, true, 3));
}

INSTANTIATE_TEST_SUITE_P (VoxelSizes, HullConstraintTest, testing::Values (0.001, 0.005, 0.01));

TEST (FreeSpaceViewTest, TakesADepthOfZeroForAHole)
{
  DepthView with_nan = rendered (ballBeforeWall ()), with_zero = with_nan;
  for (int v = 20; v < 40; ++v)
    for (int u = 20; u < 50; ++u)
    {
      with_nan.depth[v * 160 + u] = not_a_number;
      with_zero.depth[v * 160 + u] = 0.0f;
    }
  const FreeSpaceView a (with_nan), b (with_zero);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 160; ++u)
      ASSERT_EQ (a.atEdge (u, v), b.atEdge (u, v)) << u << ' ' << v;
  const VoxelGrid grid = gridAbout ({0.0, 0.0, ball_m}, 48, 0.01);
  EXPECT_EQ (freeSpace (grid, {with_nan}), freeSpace (grid, {with_zero}));
}

TEST (FreeSpaceViewTest, FindsSilhouettesButNotSlopes)
{
  const RenderedView ball = ballBeforeWall ().render (smallCamera (), Eigen::Isometry3d::Identity ());
  const FreeSpaceView view (ball.view);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u + 1 < 160; ++u)
      if (ball.labels[v * 160 + u] != ball.labels[v * 160 + u + 1])
      {
        EXPECT_TRUE (view.atEdge (u, v));
        EXPECT_TRUE (view.atEdge (u + 1, v));
      }
  EXPECT_FALSE (view.atEdge (80, 60));
  EXPECT_FALSE (view.atEdge (5, 5));

  AnalyticScene slope; // 60 degrees
  slope.add (0, halfSpace ({std::sin (M_PI / 3.0), 0.0, -std::cos (M_PI / 3.0), 0.5}));
  const FreeSpaceView tilted (rendered (slope));
  for (int u = 0; u < 80; ++u)
    EXPECT_FALSE (tilted.atEdge (u, 60)) << u;
}

TEST (HullVotes, OneWrongViewOfTenDoesNotEraseASurface)
{
  const AnalyticScene scene = ballBeforeWall ();
  const VoxelGrid grid = gridAbout ({0.0, 0.0, ball_m}, 41, 0.005);
  std::vector<DepthView> views (9, rendered (scene));
  const std::vector<std::uint8_t> right = freeSpace (grid, views);
  views.push_back (rendered (wallOnly ())); // did not see the ball
  const std::vector<std::uint8_t> revised = freeSpace (grid, views, true);
  const std::vector<std::uint8_t> paper = freeSpace (grid, views, false);
  const FreeSpaceView seen (views.front ());
  std::size_t surface = 0, kept = 0, erased = 0, lost = 0;
  forEachVoxel (grid, [&] (std::size_t n, const Eigen::Vector3d& p) {
    lost += right[n] && !(revised[n] && paper[n]);
    const Footprint at = footprint (seen, p, 0);
    if (at.farthest > ball_m || std::abs (at.nearest - p.z ()) > 0.9 * margin (grid, at.nearest))
      return; // not at the ball's seen surface
    ++surface;
    kept += !revised[n];
    erased += paper[n];
  });
  EXPECT_GT (surface, 1000u);
  EXPECT_EQ (kept, surface);
  EXPECT_EQ (erased, surface);
  EXPECT_EQ (lost, 0u) << "voxels that all views see free";
}

TEST (HullVotes, AreCounted)
{
  const VoxelGrid at_front = gridAbout ({0.0, 0.0, ball_m - ball_radius_m}, 3, 0.005);
  const std::size_t centre = at_front.index (1, 1, 1);
  const DepthView with = rendered (ballBeforeWall ());
  const DepthView without = rendered (wallOnly ());
  EXPECT_EQ (freeSpace (at_front, {without})[centre], 1);
  EXPECT_EQ (freeSpace (at_front, {with})[centre], 0);
  EXPECT_EQ (freeSpace (at_front, {without, with})[centre], 0) << "a tie frees nothing";
  EXPECT_EQ (freeSpace (at_front, {without, with, without})[centre], 1);
  EXPECT_EQ (freeSpace (at_front, {without, with, without, with})[centre], 0);
}

TEST (HullVotes, DoNotOverflow)
{
  const VoxelGrid at_front = gridAbout ({0.0, 0.0, ball_m - ball_radius_m}, 3, 0.005);
  const FreeSpaceView with (rendered (ballBeforeWall ()));
  const FreeSpaceView without (rendered (wallOnly ()));
  HullConstraint hull (at_front, 1);
  for (int i = 0; i < 300; ++i)
    hull.add (without, Eigen::Isometry3d::Identity ());
  for (int i = 0; i < 20; ++i)
    hull.add (with, Eigen::Isometry3d::Identity ());
  EXPECT_EQ (hull.freeSpace (true)[at_front.index (1, 1, 1)], 1);
}

/** \brief The surface of another body bounds what is free without a margin, and does not speak for this body. */
TEST (HullVotes, ReachTheSurfaceOfAnotherBody)
{
  constexpr double voxel_size_m = 0.005;
  const DepthView wall = rendered (wallOnly ());
  const std::vector<int> bodies (wall.depth.size (), 7);
  const auto isFree = [&] (double before_wall_m, int body, bool seen_through) {
    const VoxelGrid grid = gridAbout ({0.0, 0.0, wall_m - before_wall_m}, 3, voxel_size_m);
    HullConstraint hull (grid, 1);
    hull.add (FreeSpaceView (wall, bodies), Eigen::Isometry3d::Identity (), body);
    if (seen_through)
    {
      AnalyticScene farther;
      farther.add (0, halfSpace ({0.0, 0.0, -1.0, 2.0 * wall_m}));
      hull.add (FreeSpaceView (rendered (farther)), Eigen::Isometry3d::Identity (), body);
    }
    return hull.freeSpace (true)[grid.index (1, 1, 1)] != 0;
  };
  for (const double before_m : {0.001, 0.5 * voxel_size_m, 2.0 * voxel_size_m})
  {
    EXPECT_TRUE (isFree (before_m, 3, false)) << before_m;
    EXPECT_FALSE (isFree (before_m, 7, false)) << before_m;
    EXPECT_FALSE (isFree (before_m, FreeSpaceView::unknown_body, false)) << before_m;
  }
  EXPECT_FALSE (isFree (-0.001, 3, false));
  EXPECT_TRUE (isFree (-0.001, 3, true));
  EXPECT_FALSE (isFree (-0.001, 7, true)) << "a tie frees nothing";
}

/** \brief Poses and grids turn together. */
TEST (HullVotes, FollowThePose)
{
  const VoxelGrid grid = gridAbout ({0.0, 0.0, ball_m}, 21, 0.01);
  const FreeSpaceView view (rendered (ballBeforeWall ()));
  HullConstraint straight (grid, 1);
  straight.add (view, Eigen::Isometry3d::Identity ());

  // A grid frame turned by 90 degrees about the optical axis, with its origin at the ball.
  Eigen::Isometry3d T_grid_sensor = Eigen::Isometry3d::Identity ();
  T_grid_sensor.linear () << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_grid_sensor.translation () = Eigen::Vector3d (0.0, 0.0, -ball_m);
  const VoxelGrid turned = gridAbout (Eigen::Vector3d::Zero (), 21, 0.01);
  HullConstraint moved (turned, 1);
  moved.add (view, T_grid_sensor);
  const std::vector<std::uint8_t> a = straight.freeSpace (true);
  const std::vector<std::uint8_t> b = moved.freeSpace (true);
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 21; ++j)
      for (int i = 0; i < 21; ++i)
        EXPECT_EQ (a[grid.index (i, j, k)], b[turned.index (20 - j, i, k)]) << i << " " << j << " " << k;
}
