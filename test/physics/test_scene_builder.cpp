// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Rigid bodies of completed objects: masses, parts, frames, and how they stand.

#include "physical_scenes.h"

#include "pcl_cosection/physics/part_contacts.h"

#include <gtest/gtest.h>

namespace pcl::cosection::test {
namespace {

constexpr double gravity_m_s2 = 9.80665;

Eigen::Isometry3d
tiltedFrame (double angle_rad)
{
  return Eigen::Translation3d (0.4, -0.3, 0.7) *
         Eigen::AngleAxisd (angle_rad, Eigen::Vector3d (1.0, 0.6, 0.0).normalized ());
}

std::size_t
countWarnings (const PhysicalScene& scene, const std::string& part)
{
  return static_cast<std::size_t> (
      std::count_if (scene.warnings.begin (), scene.warnings.end (),
                     [&] (const std::string& warning) { return warning.find (part) != std::string::npos; }));
}

/** \brief The frame of the result is where the scene says, and bodies are there where objects were. */
void
expectSamePlaces (const PhysicalScene& scene, const CompletedScene& completed)
{
  for (std::size_t n = 0; n < completed.objects.size (); ++n)
  {
    const CompletedObject& object = completed.objects[n];
    const PhysicalBody& body = scene.bodies[n];
    ASSERT_EQ (body.visual.triangles, object.mesh.triangles);
    double farthest = 0.0;
    for (std::size_t v = 0; v < object.mesh.vertices.size (); ++v)
      farthest = std::max (farthest,
                           (scene.T_result_scene * body.T_scene_body * body.visual.vertices[v].cast<double> () -
                            object.T_world_object * object.mesh.vertices[v].cast<double> ())
                               .norm ());
    EXPECT_LT (farthest, 1e-6);
  }
  for (std::size_t n = 0; n < completed.planes.size (); ++n)
  {
    const Eigen::Isometry3d T = scene.T_result_scene * scene.planes[n].T_scene_plane;
    EXPECT_TRUE (T.linear ().col (2).isApprox (completed.planes[n].head<3> (), 1e-9));
    EXPECT_NEAR (completed.planes[n].head<3> ().dot (T.translation ()) + completed.planes[n][3], 0.0, 1e-9);
  }
}

/** \brief Feet lie on the plane, around the centre of mass as seen from above. */
void
expectFeet (const PhysicalBody& body, const PhysicalScene& scene)
{
  ASSERT_GE (body.stands_on, 0) << body.name;
  ASSERT_GE (body.feet.size (), 3u) << body.name;
  EXPECT_LE (body.feet.size (), 8u);
  const Eigen::Isometry3d T_plane_body = scene.planes[body.stands_on].T_scene_plane.inverse () * body.T_scene_body;
  const Eigen::Vector3d centre = T_plane_body * body.centre_m;
  for (std::size_t n = 0; n < body.feet.size (); ++n)
  {
    const Eigen::Vector3d a = T_plane_body * body.feet[n];
    const Eigen::Vector3d b = T_plane_body * body.feet[(n + 1) % body.feet.size ()];
    EXPECT_NEAR (a.z (), 0.0, 1e-6);
    EXPECT_GT ((b - a).cross (centre - a).z (), 0.0) << body.name;
  }
}

void
expectInertia (const PhysicalBody& body, double mass_kg, const Eigen::Vector3d& moments, const Eigen::Matrix3d& axes)
{
  EXPECT_NEAR (body.mass_kg, mass_kg, 0.01 * mass_kg);
  const Eigen::Matrix3d expected = axes * moments.asDiagonal () * axes.transpose ();
  EXPECT_LT ((body.inertia - expected).norm (), 0.01 * expected.norm ());
}

// --- Masses ---

TEST (SceneBuilder, MassesAndInertiaAreThoseOfTheFormulas)
{
  const double a = 0.1, b = 0.08, c = 0.06, r = 0.033, h = 0.12, ball = 0.04;
  const Eigen::Isometry3d T = placeAt (0.3, -0.1, 0.4);
  const Eigen::Isometry3d lying = Eigen::Translation3d (0.0, 0.4, r) *
                                  Eigen::AngleAxisd (M_PI_2, Eigen::Vector3d (1.0, 1.0, 0.0).normalized ());
  const CompletedScene completed = sceneOf (
      {objectOf (1, "box", boxMesh ({-0.05f, -0.04f, 0.0f}, {0.05f, 0.04f, 0.06f}), T),
       objectOf (2, "can", canMesh (r, h, 0.00005), lying),
       objectOf (3, "ball", sphereMesh (ball, 60), Eigen::Isometry3d (Eigen::Translation3d (-0.3, 0.0, ball)))});
  PhysicsOptions options;
  options.density_kg_m3 = 800.0;
  options.masses_kg[3] = 0.7;
  options.max_parts = 1;
  const PhysicalScene scene = buildPhysicalScene (completed, options);
  ASSERT_EQ (scene.bodies.size (), 3u);
  const double m = 800.0 * a * b * c, n = 800.0 * M_PI * r * r * h;
  expectInertia (scene.bodies[0], m, m / 12.0 * Eigen::Vector3d (b * b + c * c, a * a + c * c, a * a + b * b),
                 T.linear ());
  const double across = n / 12.0 * (3.0 * r * r + h * h);
  expectInertia (scene.bodies[1], n, {across, across, 0.5 * n * r * r}, lying.linear ());
  expectInertia (scene.bodies[2], 0.7, Eigen::Vector3d::Constant (0.4 * 0.7 * ball * ball),
                 Eigen::Matrix3d::Identity ());
  EXPECT_NEAR (scene.bodies[2].volume_m3, 4.0 / 3.0 * M_PI * std::pow (ball, 3), 0.01 * scene.bodies[2].volume_m3);
  const Eigen::Vector3d centres[] = {
      T * Eigen::Vector3d (0.0, 0.0, 0.5 * c), lying * Eigen::Vector3d (0.0, 0.0, 0.5 * h), {-0.3, 0.0, ball}};
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_LT ((scene.bodies[k].T_scene_body.translation () - centres[k]).norm (), 1e-5);
    EXPECT_TRUE (scene.bodies[k].T_scene_body.linear ().isIdentity (1e-12));
    EXPECT_EQ (scene.bodies[k].id, k + 1);
    EXPECT_FALSE (scene.bodies[k].isStatic ());
  }
  EXPECT_EQ (scene.bodies[0].centre_m, Eigen::Vector3d::Zero ());
}

// --- Parts ---

TEST (SceneBuilder, PartsContainTheEstimateAndLittleElse)
{
  PhysicsOptions options;
  for (const int max_parts : {1, 4, 16})
  {
    options.max_parts = max_parts;
    const CompletedScene completed = fourThings ();
    const PhysicalScene scene = buildPhysicalScene (completed, options);
    EXPECT_TRUE (scene.warnings.empty ()) << scene.warnings.front ();
    for (const PhysicalBody& body : scene.bodies)
    {
      EXPECT_LE (body.parts.size (), static_cast<std::size_t> (max_parts));
      EXPECT_LE (farthestOutside (hullsOf (body), body.visual, body.T_scene_body), 1e-6) << body.name;
      EXPECT_EQ (body.missing_m, 0.0);
      EXPECT_TRUE (body.convex);
      double volume = 0.0;
      for (const TriangleMesh& part : body.parts)
      {
        EXPECT_TRUE (computeTopology (part).closed_manifold);
        volume += computeMassProperties (part).volume_m3;
      }
      EXPECT_NEAR (volume, body.parts_volume_m3, 1e-3 * volume);
      const bool is_cup = body.id == 4;
      if (max_parts > 1 && !is_cup)
      {
        EXPECT_LE (body.parts_volume_m3, 1.15 * body.volume_m3) << body.name;
        EXPECT_LT (body.excess_m, 0.001) << body.name;
      }
      if (max_parts == 16 && is_cup)
      {
        EXPECT_LE (body.parts_volume_m3, 1.35 * body.volume_m3);
        EXPECT_LT (depthIn (hullsOf (body), body.T_scene_body * Eigen::Vector3d::Zero ()), 0.0); // its cavity
      }
    }
    EXPECT_EQ (scene.bodies[0].parts.size (), 1u);
    EXPECT_EQ (scene.bodies[1].parts.size (), 1u);
  }
}

TEST (SceneBuilder, ShapesToCollideBy)
{
  CompletedScene completed = fourThings ();
  PhysicsOptions options;
  options.collision = CollisionShape::Hull;
  for (const PhysicalBody& body : buildPhysicalScene (completed, options).bodies)
    EXPECT_EQ (body.parts.size (), 1u);
  options.collision = CollisionShape::Mesh;
  for (const PhysicalBody& body : buildPhysicalScene (completed, options).bodies)
  {
    ASSERT_EQ (body.parts.size (), 1u);
    EXPECT_EQ (body.parts[0].triangles, body.visual.triangles);
    EXPECT_FALSE (body.convex);
  }
  options.collision = CollisionShape::Outer;
  for (CompletedObject& object : completed.objects)
    object.outer = boxMesh ({-0.12f, -0.12f, 0.0f}, {0.12f, 0.12f, 0.15f});
  for (const PhysicalBody& body : buildPhysicalScene (completed, options).bodies)
  {
    EXPECT_NEAR (body.parts_volume_m3, 0.24 * 0.24 * 0.15, 1e-6);
    EXPECT_LT (body.volume_m3, 0.001); // the masses are those of the estimates
  }
}

TEST (SceneBuilder, PartsOfInterlockingBodiesHardlyOverlap)
{
  const CompletedScene completed = interlockingThings ();
  const PhysicsOptions options;
  const PhysicalScene scene = buildPhysicalScene (completed, options);
  double deepest = -1.0;
  for (std::size_t a = 0; a < scene.bodies.size (); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const ConvexHull& first : hullsOf (scene.bodies[a]))
        for (const ConvexHull& second : hullsOf (scene.bodies[b]))
          deepest = std::max (deepest, separationOf (first, second).depth_m);
  EXPECT_LE (deepest, options.contact_tolerance_m + 1e-6);
  for (const PhysicalBody& body : scene.bodies)
  {
    EXPECT_LT (body.missing_m, 0.0005) << body.name; // hardly anything was cut off
    EXPECT_LE (body.parts.size (), 16u);
  }
  EXPECT_EQ (scene.bodies[0].parts.size (), 2u);
  EXPECT_EQ (scene.bodies[1].parts.size (), 1u);
}

// --- Where it is, and what it stands on ---

TEST (SceneBuilder, TheFrameIsThatOfTheResultIfItsZAxisIsUp)
{
  for (const double tilt : {0.0, 0.02}) // up to 2 degrees
  {
    const CompletedScene completed = movedScene (fourThings (), tiltedFrame (tilt));
    const PhysicalScene scene = buildPhysicalScene (completed, {});
    EXPECT_TRUE (scene.T_result_scene.isApprox (Eigen::Isometry3d::Identity (), 0.0));
    EXPECT_LT ((scene.gravity + gravity_m_s2 * tiltedFrame (tilt).linear ().col (2)).norm (), 1e-9);
    expectSamePlaces (scene, completed);
  }
}

TEST (SceneBuilder, TheFrameOfTheTableHasZUp)
{
  for (const double tilt : {0.0, 0.3, 2.0, M_PI})
    for (const SceneFrame frame : {SceneFrame::Auto, SceneFrame::Table})
    {
      if (tilt == 0.0 && frame == SceneFrame::Auto)
        continue;
      const CompletedScene completed = movedScene (fourThings (), tiltedFrame (tilt));
      PhysicsOptions options;
      options.frame = frame;
      const PhysicalScene scene = buildPhysicalScene (completed, options);
      EXPECT_LT ((scene.gravity - Eigen::Vector3d (0.0, 0.0, -gravity_m_s2)).norm (), 1e-12);
      EXPECT_NEAR (scene.T_result_scene.linear ().determinant (), 1.0, 1e-12);
      EXPECT_NEAR (scene.planes.at (0).T_scene_plane.translation ().z (), 0.0, 1e-9);
      EXPECT_TRUE (scene.planes[0].T_scene_plane.linear ().col (2).isApprox (Eigen::Vector3d::UnitZ (), 1e-9));
      EXPECT_TRUE (scene.planes[0].endless);
      expectSamePlaces (scene, completed);
      Eigen::AlignedBox3d box;
      for (const PhysicalBody& body : scene.bodies)
        box.extend (body.T_scene_body.translation ());
      EXPECT_LT (box.center ().head<2> ().norm (), 0.1); // the origin is below the objects
    }
}

TEST (SceneBuilder, BodiesStandOnTheirFeet)
{
  for (const double tilt : {0.0, 0.3})
    for (const SceneFrame frame : {SceneFrame::Result, SceneFrame::Table})
    {
      PhysicsOptions options;
      options.frame = frame;
      const PhysicalScene scene = buildPhysicalScene (movedScene (fourThings (), tiltedFrame (tilt)), options);
      EXPECT_TRUE (scene.warnings.empty ()) << scene.warnings.front ();
      for (const PhysicalBody& body : scene.bodies)
      {
        expectFeet (body, scene);
        EXPECT_EQ (body.centre_shift_m, 0.0);
      }
    }
}

TEST (SceneBuilder, ABodyWhoseCentreIsBesideItsFeetIsMadeToStand)
{
  for (const double tilt : {0.0, 0.3})
  {
    const CompletedScene completed = movedScene (
        sceneOf ({objectOf (7, "lamp", overhangingMesh (), placeAt (0.1, 0.2, 0.8))}), tiltedFrame (tilt));
    const PhysicalScene scene = buildPhysicalScene (completed, {});
    ASSERT_EQ (scene.warnings.size (), 1u);
    EXPECT_NE (scene.warnings[0].find ("lamp_7: its centre of mass was moved by 1"), std::string::npos)
        << scene.warnings[0];
    const PhysicalBody& body = scene.bodies[0];
    EXPECT_GT (body.centre_shift_m, 0.0434 - 0.03);
    EXPECT_LT (body.centre_shift_m, 0.0434 - 0.03 + 0.005);
    EXPECT_NEAR (body.centre_m.norm (), body.centre_shift_m, 1e-9);
    EXPECT_NEAR (body.centre_m.dot (scene.gravity), 0.0, 1e-9);
    expectFeet (body, scene);
  }
}

TEST (SceneBuilder, BodiesEndAtWallsAndLeanOnThem)
{
  // A box that reaches a little into the wall x = 0, and a board whose top leans on it; another box is far from it.
  const float into_m = -0.5f * static_cast<float> (test_voxel_m);
  const Eigen::Isometry3d leaning (Eigen::Translation3d (0.102, 0.3, 0.0) *
                                   Eigen::AngleAxisd (-0.35, Eigen::Vector3d::UnitY ()));
  CompletedScene scene = sceneOf ({objectOf (1, "box", boxMesh ({into_m, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f})),
                                   objectOf (2, "board", boxMesh ({0.0f, 0.0f, 0.0f}, {0.01f, 0.2f, 0.3f}), leaning),
                                   objectOf (3, "far", boxMesh ({0.5f, -1.0f, 0.0f}, {0.6f, -0.9f, 0.1f}))});
  const auto warnsOfTheBoard = [] (const PhysicalScene& built) {
    return std::any_of (built.warnings.begin (), built.warnings.end (),
                        [] (const std::string& line) { return line.find ("board_2") != std::string::npos; });
  };
  EXPECT_TRUE (warnsOfTheBoard (buildPhysicalScene (scene, {}))); // without the wall it would fall
  scene.planes.emplace_back (1.0, 0.0, 0.0, 0.0);
  const PhysicalScene built = buildPhysicalScene (scene, {});
  EXPECT_FALSE (warnsOfTheBoard (built));
  EXPECT_EQ (built.bodies[1].centre_shift_m, 0.0);
  for (std::size_t n = 0; n < 2; ++n)
    for (const TriangleMesh& part : built.bodies[n].parts)
      for (const Eigen::Vector3f& vertex : part.vertices)
        EXPECT_GT ((built.bodies[n].T_scene_body * vertex.cast<double> ()).x (), -1e-6);
  EXPECT_LT (2.0 * built.planes[1].half_size_m.maxCoeff (), 3.01 * 0.5); // of what is near it, and as much around
}

TEST (SceneBuilder, ABodyWithinAnotherIsSaid)
{
  const CompletedScene scene = sceneOf ({objectOf (1, "outer", boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f})),
                                         objectOf (2, "inner", boxMesh ({0.04f, 0.04f, 0.04f}, {0.06f, 0.06f, 0.06f})),
                                         objectOf (3, "beside", boxMesh ({0.1f, 0.0f, 0.0f}, {0.2f, 0.1f, 0.1f}))});
  const std::vector<std::string> warnings = buildPhysicalScene (scene, {}).warnings;
  for (const auto& [name, is_said] : {std::pair ("outer_1", true), {"inner_2", true}, {"beside_3", false}})
    EXPECT_EQ (std::any_of (warnings.begin (), warnings.end (),
                            [&, &name = name] (const std::string& line) {
                              return line.find (std::string (name) + ": is within a part of another object") == 0;
                            }),
               is_said)
        << name;
}

TEST (SceneBuilder, WithoutAPlaneThereIsAWarning)
{
  CompletedScene completed = fourThings ();
  completed.planes.clear ();
  const PhysicalScene scene = buildPhysicalScene (completed, {});
  EXPECT_TRUE (scene.planes.empty ());
  EXPECT_EQ (countWarnings (scene, "no support plane"), 1u);
  for (const PhysicalBody& body : scene.bodies)
  {
    EXPECT_EQ (body.stands_on, -1);
    EXPECT_TRUE (body.feet.empty ());
  }
}

} // namespace
} // namespace pcl::cosection::test
