// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/simulation/penetration_check.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

SceneBody
bodyOf (int id, std::vector<BodyPart> parts, const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity ())
{
  return {id == 0 ? "room" : "body" + std::to_string (id), id, std::move (parts), KeyedMotion (T), 0.0};
}

Eigen::Isometry3d
at (double x, double y, double z, double turn = 0.0)
{
  return Eigen::Isometry3d (Eigen::Translation3d (x, y, z) *
                            Eigen::AngleAxisd (turn, Eigen::Vector3d (1, 2, 3).normalized ()));
}

/** \brief Depth of a sphere along the ray of a pixel; NaN if there is none. */
double
sphereDepth (const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& ray)
{
  const double b = ray.dot (centre), c = centre.squaredNorm () - radius * radius, a = ray.squaredNorm ();
  return (b - std::sqrt (b * b - a * c)) / a;
}

} // namespace

TEST (SceneRenderer, DepthIsWhereTheDistanceIsZero)
{
  for (const ScenePreset& preset : scenePresets ())
  {
    const SimulatedScene scene = parseSceneSpec (preset.spec, preset.name);
    const SceneRenderer renderer (scene);
    for (const int number : {0, scene.frames / 2})
    {
      const double time = scene.timeOf (number);
      const SimulatedFrame frame = renderer.render (time);
      std::size_t seen = 0;
      double farthest = 0.0;
      for (int v = 0; v < scene.camera.height; ++v)
        for (int u = 0; u < scene.camera.width; ++u)
        {
          const float z = frame.depth.at (u, v);
          if (!std::isfinite (z))
            continue;
          ++seen;
          const Eigen::Vector3d p = frame.T_world_camera * scene.camera.unproject (u, v, z);
          double nearest = 1.0;
          for (const SceneBody& body : scene.bodies)
            if (body.id == frame.mask.at (u, v))
              nearest = std::abs (body.distance (body.motion.at (time).inverse () * p));
          farthest = std::max (farthest, nearest);
        }
      EXPECT_LE (farthest, 1e-4) << preset.name;
      EXPECT_GT (seen, frame.depth.pixels.size () * 3 / 4) << preset.name;
    }
  }
}

TEST (SceneRenderer, DepthOfASphereIsThatOfItsFormula)
{
  SimulatedScene scene;
  const Eigen::Vector3d centre (0.02, -0.01, 0.7);
  scene.bodies = {bodyOf (0, {}), bodyOf (7, {{makeSphere (0.1)}}, at (centre.x (), centre.y (), centre.z ()))};
  const SimulatedFrame frame = SceneRenderer (scene).render (0.0);
  int wrong_outline = 0, seen = 0;
  for (int v = 0; v < scene.camera.height; ++v)
    for (int u = 0; u < scene.camera.width; ++u)
    {
      const double z = sphereDepth (centre, 0.1, scene.camera.unproject (u, v, 1.0));
      EXPECT_EQ (std::isfinite (frame.depth.at (u, v)), frame.mask.at (u, v) == 7);
      if (std::isfinite (z) != std::isfinite (frame.depth.at (u, v)))
        ++wrong_outline;
      else if (std::isfinite (z))
      {
        ++seen;
        ASSERT_NEAR (frame.depth.at (u, v), z, 1e-4);
      }
    }
  EXPECT_GT (seen, 15000);
  EXPECT_LE (wrong_outline, 8); // rays within the hundredth of a millimetre that triangles keep from the ball
}

TEST (SceneRenderer, DepthOfAMeshIsThatOfItsTriangles)
{
  TriangleMesh mesh;
  mesh.vertices = {{-0.3f, -0.2f, 0.1f}, {0.4f, -0.25f, 0.05f}, {0.1f, 0.3f, -0.1f}};
  mesh.triangles = {{0, 2, 1}};
  SimulatedScene scene;
  const Eigen::Isometry3d T = at (0.0, 0.0, 1.0, 0.1);
  scene.bodies = {bodyOf (0, {}), bodyOf (1, {{makeMeshShape (mesh)}}, T)};
  const SimulatedFrame frame = SceneRenderer (scene).render (0.0);
  const Eigen::Vector3d a = T * mesh.vertices[0].cast<double> (), b = T * mesh.vertices[1].cast<double> (),
                        c = T * mesh.vertices[2].cast<double> ();
  const Eigen::Vector3d n = (b - a).cross (c - a);
  int seen = 0;
  for (int v = 0; v < scene.camera.height; ++v)
    for (int u = 0; u < scene.camera.width; ++u)
      if (std::isfinite (frame.depth.at (u, v)))
      {
        ++seen;
        ASSERT_NEAR (frame.depth.at (u, v), n.dot (a) / n.dot (scene.camera.unproject (u, v, 1.0)), 5e-7);
      }
  EXPECT_GT (seen, 30000);
}

TEST (SceneRenderer, NearerBodiesHideOthers)
{
  SimulatedScene scene;
  scene.bodies = {
      bodyOf (0, {{makeHalfSpace (20.0), at (0, 0, 3) * Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitX ())}}),
      bodyOf (1, {{makeSphere (0.2)}}, at (0, 0, 1.5)), bodyOf (300, {{makeSphere (0.1)}}, at (0, 0, 1.0))};
  const SimulatedFrame frame = SceneRenderer (scene).render (0.0);
  EXPECT_EQ (frame.mask.at (320, 240), 300);
  EXPECT_NEAR (frame.depth.at (320, 240), 0.9, 1e-3);
  EXPECT_EQ (frame.mask.at (320 + 60, 240), 1);
  EXPECT_EQ (frame.mask.at (10, 10), 0);
  EXPECT_NEAR (frame.depth.at (10, 10), 3.0, 1e-5);
  EXPECT_NEAR (frame.normals[0].norm (), 1.0f, 1e-5f);
}

TEST (PenetrationCheck, PresetsAreFreeOfIt)
{
  for (const ScenePreset& preset : scenePresets ())
    EXPECT_TRUE (findPenetrations (parseSceneSpec (preset.spec, preset.name)).empty ()) << preset.name;
}

TEST (PenetrationCheck, FindsHowDeepAndWhen)
{
  SimulatedScene scene;
  scene.frames = 11;
  scene.rate = 10.0;
  SceneBody ball = bodyOf (2, {{makeSphere (0.05)}});
  ball.motion = KeyedMotion (KeyedVector ({0.0, 1.0}, {{0.2, 0, 0.05}, {0.09, 0, 0.05}}),
                             KeyedRotation ({0.0}, {Eigen::Quaterniond::Identity ()}));
  scene.bodies = {bodyOf (0, {{makeHalfSpace (5.0)}}), bodyOf (1, {{makeBox ({0.1, 0.1, 0.1})}}, at (0, 0, 0.05)),
                  ball};
  const std::vector<ScenePenetration> found = findPenetrations (scene);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (found[0].first, "body1");
  EXPECT_EQ (found[0].second, "body2");
  EXPECT_NEAR (found[0].depth_m, 0.01, 5e-4);
  EXPECT_EQ (found[0].frame, 10);
  EXPECT_GE (found[0].frames, 1);
  EXPECT_LE (found[0].frames, 4);
}

TEST (PenetrationCheck, FindsThinBoardsThatCross)
{
  SimulatedScene scene;
  scene.bodies = {bodyOf (0, {}), bodyOf (1, {{makeBox ({2.0, 2.0, 0.003})}}),
                  bodyOf (2, {{makeBox ({2.0, 0.003, 2.0})}})};
  EXPECT_EQ (findPenetrations (scene).size (), 1u);
}

TEST (PenetrationCheck, LongThinTrianglesAreNoWorkMore)
{
  SimulatedScene scene;
  const Shape::ConstPtr pipe = makeCylinder (0.025, 1.0);
  scene.bodies = {bodyOf (0, {}), bodyOf (1, {{makeMeshShape (pipe->tessellate (1e-9))}}),
                  bodyOf (2, {{makeSphere (0.02)}}, at (0.1, 0, 0))};
  EXPECT_TRUE (findPenetrations (scene).empty ());
  const ProgressCallback stop = [] (const std::string&, double) { return false; };
  EXPECT_THROW (findPenetrations (scene, {}, stop), Cancelled);
}

TEST (PenetrationCheck, FindsWhatSinksIntoTheFloor)
{
  SimulatedScene scene;
  scene.bodies = {bodyOf (0, {{makeHalfSpace (5.0)}}), bodyOf (1, {{makeBox ({0.1, 0.1, 0.1})}}, at (0, 0, 0.045))};
  const std::vector<ScenePenetration> found = findPenetrations (scene);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_NEAR (found[0].depth_m, 0.005, 1e-6);
  // As a mesh as well, though its distance is interpolated.
  scene.bodies[1].parts[0].shape = makeMeshShape (makeBox ({0.1, 0.1, 0.1})->tessellate (1e-4));
  EXPECT_EQ (findPenetrations (scene).size (), 1u);
}
