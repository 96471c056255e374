// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Objects that stand on the top of another one, or behind one that hides their lower end.

#include "completion/lowest_vertex.h"
#include "completion_scene.h"
#include "pcl_cosection/mesh/moved_mesh.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector3d lower_half (0.1, 0.08, 0.015), upper_half (0.07, 0.055, 0.015);

/** \brief A flat box on the table, and another one. */
SceneResult
completed (const Eigen::Vector3d& half_of_other, const Eigen::Vector3d& place_of_other, const Eigen::Vector3d& eye)
{
  AnalyticScene scene;
  scene.add (0, halfSpace (table_plane));
  scene.add (1, placed (box (lower_half), Eigen::Vector3d (0.0, 0.0, lower_half.z ())));
  scene.add (2, placed (box (half_of_other), place_of_other));
  return complete (scene.render (tableCamera (), lookAt (eye, {0.0, 0.0, 0.03})), optionsFor (0.004));
}

double
volumeOf (const Eigen::Vector3d& half)
{
  return 8.0 * half.prod ();
}

} // namespace

TEST (StackedObjects, OneStandsOnTheTopOfTheOther)
{
  const Eigen::Vector3d on_top (-0.01, 0.01, 2.0 * lower_half.z () + upper_half.z ());
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d (-0.25, -0.4, 0.4), Eigen::Vector3d (0.1, -0.3, 0.5)})
  {
    const SceneResult result = completed (upper_half, on_top, eye);
    ASSERT_EQ (result.objects.size (), 2u);
    const TriangleMesh &lower = result.objects[0].mesh, &upper = result.objects[1].mesh;
    EXPECT_NEAR (lowest (upper), 2.0 * lower_half.z (), 0.004);
    EXPECT_NEAR (computeMassProperties (upper).volume_m3, volumeOf (upper_half), 0.2 * volumeOf (upper_half));
    EXPECT_NEAR (computeMassProperties (lower).volume_m3, volumeOf (lower_half), 0.2 * volumeOf (lower_half));
    EXPECT_EQ (result.planes.size (), 1u); // the table alone
  }
}

/** \brief The lower end of what stands behind something low looks as if it were on its top. */
TEST (StackedObjects, WhatStandsBehindALowOneStandsOnTheTable)
{
  const Eigen::Vector3d half (0.07, 0.055, 0.06), behind (0.0, lower_half.y () + half.y () + 0.002, half.z ());
  const SceneResult result = completed (half, behind, {0.05, -0.45, 0.25});
  ASSERT_EQ (result.objects.size (), 2u);
  EXPECT_LT (lowest (result.objects[1].mesh), 0.008);
}

/** \brief In a frame whose axes are not vertical, the box of what is seen of a neighbour must not reach behind it. */
TEST (StackedObjects, AFootThatATouchingNeighbourHidesIsOnTheTable)
{
  const double radius_m = 0.033, height_m = 0.12, apart_m = 0.068, turn = M_PI / 9.0;
  AnalyticScene scene;
  scene.add (0, halfSpace (table_plane));
  for (int n = 0; n < 6; ++n)
    scene.add (n + 1, [=] (const Eigen::Vector3d& p) {
      const Eigen::Vector3d q = p - Eigen::Vector3d (apart_m * (n / 2), apart_m * (n % 2), 0.5 * height_m);
      return std::max (q.head<2> ().norm () - radius_m, std::abs (q.z ()) - 0.5 * height_m);
    });
  const Eigen::Vector3d target (0.0, 0.0, 0.05);
  const Eigen::Vector3d eye = target + Eigen::Vector3d (0.5 * std::sin (turn), -0.5 * std::cos (turn), 0.5);
  const Eigen::Isometry3d T = lookAt (eye, target).inverse (); // the frame of the sensor
  const SceneResult result = complete (scene.moved (T).render (tableCamera (), Eigen::Isometry3d::Identity ()),
                                       optionsFor (0.004));
  ASSERT_EQ (result.objects.size (), 6u);
  for (const ObjectResult& object : result.objects)
    EXPECT_LT (lowest (movedMesh (object.mesh, T.inverse ())), 0.01) << object.id;
}
