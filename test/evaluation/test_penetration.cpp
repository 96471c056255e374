// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "evaluation_meshes.h"

#include "pcl_cosection/evaluation/free_space_violation.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/penetration.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

PenetrationBody
box (const Eigen::Vector3f& low, const Eigen::Vector3f& high, const PenetrationOptions& options = {})
{
  return PenetrationBody (boxMesh (low, high), options);
}

} // namespace

TEST (Penetration, OfBoxesIsExact)
{
  // One extends 1 cm into the other.
  const PenetrationBody a = box ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f});
  const PenetrationBody b = box ({0.09f, 0.02f, 0.02f}, {0.2f, 0.08f, 0.08f});
  EXPECT_NEAR (a.depthOf (b), 0.01, 1e-7);
  ASSERT_TRUE (a.sharedVolume (b));
  EXPECT_NEAR (*a.sharedVolume (b), 0.01 * 0.06 * 0.06, 0.1 * 0.01 * 0.06 * 0.06);
  EXPECT_FALSE (a.isOpen ());
}

TEST (Penetration, FollowsThePose)
{
  const PenetrationBody a = box ({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f});
  const PenetrationBody b = box ({-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f});
  // Turned by 45 degrees its edge comes nearest: at 0.15 - 0.05 sqrt (2) from the centre.
  const Eigen::Isometry3d pose = motion (M_PI / 4.0, Eigen::Vector3d::UnitZ (), {0.15, 0.0, 0.0});
  EXPECT_NEAR (a.depthOf (b, pose), 0.05 * std::sqrt (2.0) - 0.05, 1e-7);
  const double tip = 0.05 * std::sqrt (2.0) - 0.05;
  EXPECT_NEAR (*a.sharedVolume (b, pose), tip * tip * 0.1, 0.05 * tip * tip * 0.1);
  EXPECT_EQ (a.depthOf (b, motion (0.0, Eigen::Vector3d::UnitZ (), {0.5, 0.0, 0.0})), 0.0);
  EXPECT_EQ (*a.sharedVolume (b, motion (0.0, Eigen::Vector3d::UnitZ (), {0.5, 0.0, 0.0})), 0.0);
}

TEST (Penetration, TouchingIsNone)
{
  const PenetrationBody a = box ({0.0f, 0.0f, 0.0f}, {0.125f, 0.125f, 0.125f});
  const PenetrationBody b = box ({0.125f, 0.0f, 0.0f}, {0.25f, 0.125f, 0.125f});
  EXPECT_EQ (a.depthOf (b), 0.0);
  EXPECT_EQ (*a.sharedVolume (b), 0.0);
}

TEST (Penetration, OfSpheresIsTheLens)
{
  constexpr double radius = 0.1, distance = 0.15;
  const PenetrationBody a (sphereMesh (radius, 64)), b (sphereMesh (radius, 64));
  const Eigen::Isometry3d pose = motion (0.0, Eigen::Vector3d::UnitZ (), {distance, 0.0, 0.0});
  EXPECT_NEAR (a.depthOf (b, pose), 2.0 * radius - distance, 0.001);
  const double lens = M_PI / 12.0 * (4.0 * radius + distance) * (2.0 * radius - distance) * (2.0 * radius - distance);
  EXPECT_NEAR (*a.sharedVolume (b, pose), lens, 0.03 * lens);
}

TEST (Penetration, CavitiesAreEmpty)
{
  TriangleMesh shell = boxMesh ({0.0f, 0.0f, 0.0f}, {0.3f, 0.3f, 0.3f});
  TriangleMesh cavity = boxMesh ({0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.2f});
  for (auto& t : cavity.triangles)
    std::swap (t[0], t[1]);
  appendMesh (shell, cavity);
  const PenetrationBody body (shell);
  EXPECT_EQ (body.depthOf (box ({0.11f, 0.11f, 0.11f}, {0.19f, 0.19f, 0.19f})), 0.0);
  EXPECT_NEAR (body.depthOf (box ({0.11f, 0.11f, 0.06f}, {0.19f, 0.19f, 0.19f})), 0.04, 1e-6);
}

TEST (Penetration, OpenMeshesHaveABandBehindThem)
{
  const PenetrationBody floor (planeMesh (1.0, 4));
  EXPECT_TRUE (floor.isOpen ());
  EXPECT_FALSE (floor.hasVolume ());
  EXPECT_NEAR (floor.depthOf (box ({0.4f, 0.4f, -0.02f}, {0.6f, 0.6f, 0.2f})), 0.02, 1e-7);
  EXPECT_EQ (floor.depthOf (box ({0.4f, 0.4f, 0.01f}, {0.6f, 0.6f, 0.2f})), 0.0);
  EXPECT_EQ (floor.depthOf (box ({2.0f, 0.4f, -0.02f}, {2.2f, 0.6f, 0.2f})), 0.0); // beside it
  EXPECT_FALSE (floor.sharedVolume (box ({0.4f, 0.4f, -0.02f}, {0.6f, 0.6f, 0.2f})));
}

TEST (Penetration, OpenPartsCanBeLeftOut)
{
  TriangleMesh mesh = planeMesh (1.0, 4);
  appendMesh (mesh, boxMesh ({0.4f, 0.4f, 0.5f}, {0.6f, 0.6f, 0.7f}));
  PenetrationOptions options;
  options.open_parts = false;
  const PenetrationBody closed (mesh, options), all (mesh);
  const PenetrationBody below = box ({0.4f, 0.4f, -0.02f}, {0.6f, 0.6f, 0.1f});
  const PenetrationBody above = box ({0.4f, 0.4f, 0.68f}, {0.6f, 0.6f, 0.9f});
  EXPECT_NEAR (all.depthOf (below), 0.02, 1e-7);
  EXPECT_EQ (closed.depthOf (below), 0.0);
  EXPECT_EQ (*closed.sharedVolume (below), 0.0);
  EXPECT_NEAR (closed.depthOf (above), 0.02, 1e-6);
  EXPECT_NEAR (*closed.sharedVolume (above), 0.02 * 0.2 * 0.2, 0.1 * 0.02 * 0.2 * 0.2);
}

TEST (Penetration, ARoomIsSolidAround)
{
  TriangleMesh room = boxMesh ({0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f});
  for (auto& t : room.triangles)
    std::swap (t[0], t[1]);
  const PenetrationBody walls (room);
  const PenetrationBody through_the_floor = box ({0.4f, 0.4f, -0.1f}, {0.6f, 0.6f, 0.1f});
  EXPECT_NEAR (walls.depthOf (through_the_floor), 0.1, 1e-7);
  EXPECT_NEAR (*walls.sharedVolume (through_the_floor), 0.2 * 0.2 * 0.1, 0.02 * 0.2 * 0.2 * 0.1);
  EXPECT_NEAR (*through_the_floor.sharedVolume (walls), 0.2 * 0.2 * 0.1, 0.02 * 0.2 * 0.2 * 0.1);
  EXPECT_EQ (walls.depthOf (box ({0.4f, 0.4f, 0.1f}, {0.6f, 0.6f, 0.2f})), 0.0);
}

/** \brief A closed part of an open background that faces inward is no room: nothing outside it is matter for that. */
TEST (Penetration, ASmallCavityIsNoRoom)
{
  TriangleMesh floor = boxMesh ({-0.02f, -0.02f, -0.5f}, {0.02f, 0.02f, -0.46f});
  for (auto& t : floor.triangles)
    std::swap (t[0], t[1]);
  const auto first = static_cast<std::uint32_t> (floor.vertices.size ());
  for (const Eigen::Vector3f& corner : {Eigen::Vector3f (-1.0f, -1.0f, 0.0f), Eigen::Vector3f (1.0f, -1.0f, 0.0f),
                                        Eigen::Vector3f (1.0f, 1.0f, 0.0f), Eigen::Vector3f (-1.0f, 1.0f, 0.0f)})
    floor.vertices.push_back (corner);
  floor.triangles.push_back ({first, first + 1, first + 2});
  floor.triangles.push_back ({first, first + 2, first + 3});
  const PenetrationBody background (floor);
  EXPECT_TRUE (background.isOpen ());
  EXPECT_EQ (box ({0.3f, 0.3f, 0.2f}, {0.5f, 0.5f, 0.4f}).depthOf (background), 0.0);
  const PenetrationBody low = box ({0.3f, 0.3f, -0.03f}, {0.5f, 0.5f, 0.4f});
  EXPECT_NEAR (low.depthOf (background), 0.03, 1e-6);
  EXPECT_FALSE (low.sharedVolume (background)) << "a floor has no volume";
  appendMesh (floor, boxMesh ({0.35f, 0.35f, 0.2f}, {0.45f, 0.45f, 0.3f}));
  const double within_m3 = 0.1 * 0.1 * 0.1, below_m3 = 0.03 * 0.2 * 0.2;
  EXPECT_NEAR (low.sharedVolume (PenetrationBody (floor)).value (), within_m3 + below_m3, 0.2 * (within_m3 + below_m3));
}

TEST (Penetration, RefusesBadOptions)
{
  PenetrationOptions options;
  options.voxel_size_m = -1.0;
  EXPECT_THROW (box ({0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, options), InvalidArgument);
  options.voxel_size_m = 1e-6;
  const PenetrationBody fine = box ({0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, options);
  EXPECT_THROW (fine.sharedVolume (fine), InvalidArgument);
}

namespace {

/** \brief A camera at the origin before a wall. */
DepthView
wallView (float depth)
{
  DepthView view;
  view.camera = {64, 48, 60.0, 60.0, 31.5, 23.5};
  view.depth.assign (64 * 48, depth);
  return view;
}

} // namespace

TEST (FreeSpaceViolation, IsTheShareBeforeTheWall)
{
  // Half of the surface is 10 cm before the wall, half is on it.
  TriangleMesh mesh = planeMesh (0.2, 4, 1.9);
  TriangleMesh other = planeMesh (0.2, 4, 2.0);
  for (auto& v : other.vertices)
    v.x () -= 0.25f;
  appendMesh (mesh, other);
  const auto points = sampleSurface (mesh, 10000);
  const FreeSpaceViolation result = measureFreeSpaceViolation (points, {wallView (2.0f)}, 0.01);
  EXPECT_NEAR (result.share, 0.5, 0.025);
  EXPECT_NEAR (result.max_depth_m, 0.1, 1e-6);
  EXPECT_EQ (result.in_view, points.size ());
  EXPECT_EQ (measureFreeSpaceViolation (points, {wallView (2.0f)}, 0.11).share, 0.0);
}

TEST (FreeSpaceViolation, FollowsThePoseAndIgnoresWhatIsNotSeen)
{
  const auto points = sampleSurface (planeMesh (0.2, 4, 1.9), 1000);
  DepthView behind = wallView (2.0f);
  behind.T_world_sensor = motion (M_PI, Eigen::Vector3d::UnitX (), Eigen::Vector3d::Zero ()); // looks away
  FreeSpaceViolation result = measureFreeSpaceViolation (points, {behind});
  EXPECT_EQ (result.in_view, 0u);
  EXPECT_EQ (result.share, 0.0);
  DepthView nothing = wallView (std::numeric_limits<float>::quiet_NaN ());
  EXPECT_EQ (measureFreeSpaceViolation (points, {nothing}).in_view, 0u);
  DepthView nearer = wallView (1.7f);
  nearer.T_world_sensor.translation ().z () = 0.3;
  result = measureFreeSpaceViolation (points, {behind, nothing, nearer});
  EXPECT_EQ (result.share, 1.0);
  EXPECT_NEAR (result.max_depth_m, 0.1, 1e-6);
}

TEST (FreeSpaceViolation, AnOutlineIsNoViolation)
{
  // The left half of the image is an object at 1 m, the right half the wall: a point of the object whose image lies
  // between the two is no violation.
  DepthView view = wallView (2.0f);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 32; ++u)
      view.depth[static_cast<std::size_t> (v) * 64 + u] = 1.0f;
  const Eigen::Vector3d at_edge = view.camera.unproject (31.7, 20.2, 1.0),
                        beyond = view.camera.unproject (33.2, 20.2, 1.0);
  EXPECT_EQ (measureFreeSpaceViolation ({at_edge}, {view}).share, 0.0);
  EXPECT_EQ (measureFreeSpaceViolation ({beyond}, {view}).share, 1.0);
}
