// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/mesh_distance.h"
#include "completion_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double reach_m = 4.0 * voxel_m; // distances are clamped to this

template <typename T>
bool
sameBytes (const std::vector<T>& a, const std::vector<T>& b)
{
  return a.size () == b.size () && (a.empty () || std::memcmp (a.data (), b.data (), a.size () * sizeof (T)) == 0);
}

bool
sameMesh (const TriangleMesh& a, const TriangleMesh& b)
{
  return sameBytes (a.vertices, b.vertices) && sameBytes (a.triangles, b.triangles) &&
         sameBytes (a.normals, b.normals) && sameBytes (a.colours, b.colours) &&
         sameBytes (a.confidence, b.confidence) && sameBytes (a.sigma_m, b.sigma_m) &&
         sameBytes (a.provenance, b.provenance);
}

class Invariance : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (Invariance, UnderMotionsOfTheGrid)
{
  // The contact of a ring is found on cells of a voxel, whose number may change by one after a motion.
  const double allowed_vox = GetParam () == Shape::Torus ? 0.16 : 0.02;
  EXPECT_LE (effectOfMotion (GetParam (), voxel_m, motion (M_PI / 2.0, Eigen::Vector3d::UnitX (), {0.3, -0.2, 0.1})),
             allowed_vox);
  EXPECT_LE (effectOfMotion (GetParam (), voxel_m, motion (M_PI / 2.0, Eigen::Vector3d::UnitZ (), {-1.3, 0.7, 0.4})),
             allowed_vox);
}

TEST_P (Invariance, UnderTheNumberOfThreads)
{
  const RenderedView seen = tableScene (GetParam ()).render (tableCamera (), fromAbove ());
  CoSectionOptions options = optionsFor (voxel_m);
  const SceneResult one = complete (seen, options);
  options.threads = 2;
  const SceneResult two = complete (seen, options);
  ASSERT_FALSE (one.objects.at (0).mesh.empty ());
  ASSERT_FALSE (one.background.empty ());
  EXPECT_TRUE (sameMesh (one.objects.at (0).mesh, two.objects.at (0).mesh));
  EXPECT_TRUE (sameMesh (one.background, two.background));
}

INSTANTIATE_TEST_SUITE_P (Table, Invariance, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

/** \brief One scene with object poses, and without. */
TEST (InvarianceOfFrames, ObjectAndWorld)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  const TriangleMesh world = complete (seen, optionsFor (voxel_m)).objects.at (0).mesh;

  const Eigen::Isometry3d T_world_object = motion (M_PI / 2.0, Eigen::Vector3d::UnitZ (), {0.05, 0.1, -0.2});
  std::vector<OrientedPoint> points = seen.points.at (1);
  for (OrientedPoint& p : points)
  {
    p.position = (T_world_object.inverse () * p.position.cast<double> ()).cast<float> ();
    p.normal = (T_world_object.linear ().transpose () * p.normal.cast<double> ()).cast<float> ();
  }
  CoSection scene (optionsFor (voxel_m));
  scene.addView (seen.view);
  scene.setBackground (seen.points.at (0));
  scene.addObject ({1, points, {T_world_object}});
  TriangleMesh object = scene.reconstruct ().objects.at (0).mesh;
  for (Eigen::Vector3f& v : object.vertices)
    v = (T_world_object * v.cast<double> ()).cast<float> ();
  EXPECT_LE (meanDistance (world, object, reach_m), 0.02 * voxel_m);
  EXPECT_LE (meanDistance (object, world, reach_m), 0.02 * voxel_m);
}
