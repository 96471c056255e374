// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Rigid bodies of any objects: odd names and shapes, what is refused, and what makes no difference.

#include "physical_scenes.h"

#include "common/message_of.h"
#include "common/temporary_folder.h"
#include "pcl_cosection/physics/formats/scene_writers.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>
#include <utility>

namespace pcl::cosection::test {
namespace {

/** \brief Everything times a factor, the estimate's voxels too. */
CompletedScene
scaledScene (CompletedScene scene, double factor)
{
  for (CompletedObject& object : scene.objects)
  {
    object.mesh = movedMesh (withoutNormals (std::move (object.mesh)), Eigen::Affine3d (Eigen::Scaling (factor)));
    object.T_world_object.translation () *= factor;
    object.voxel_size_m *= factor;
  }
  return scene;
}

TEST (SceneInput, NamesAreUniqueWords)
{
  CompletedScene completed;
  completed.planes = {floor_plane};
  const std::vector<std::pair<int, std::string>> labels = {
      {1, "support"},    {2, "cup"},         {3, "cup"},
      {3, "cup"},        {4, "two words"},   {5, "Tasse gr\xc3\xbcn \xe2\x98\x95"},
      {6, ""},           {7, "../../etc/x"}, {8, "3d"},
      {0, "cup_2_part"}, {9, "\xff\xfe"},    {2, "cup_3"}};
  for (const auto& [id, label] : labels)
    completed.objects.push_back (objectOf (id, label, boxMesh ({0.0f, 0.0f, 0.0f}, {0.05f, 0.05f, 0.05f}),
                                           placeAt (0.1 * static_cast<double> (completed.objects.size ()), 0.0, 0.0)));
  const PhysicalScene scene = buildPhysicalScene (completed, {});
  std::set<std::string> names;
  for (const PhysicalPlane& plane : scene.planes)
    names.insert (plane.name);
  for (const PhysicalBody& body : scene.bodies)
  {
    EXPECT_TRUE (names.insert (body.name).second) << body.name;
    EXPECT_TRUE (std::regex_match (body.name, std::regex ("[A-Za-z_][A-Za-z0-9_]*"))) << body.name;
  }
  EXPECT_EQ (scene.bodies[1].name, "cup_2");
  EXPECT_EQ (scene.bodies[6].name, "object_6");
  const TemporaryFolder folder;
  const std::vector<std::string> files = writeUrdf (scene, folder.file (""));
  EXPECT_EQ (std::set<std::string> (files.begin (), files.end ()).size (), files.size ()); // parts too
}

TEST (SceneInput, SaysWhatIsWrong)
{
  const CompletedScene good = sceneOf ({objectOf (5, "box", boxMesh ({0, 0, 0}, {0.1f, 0.1f, 0.1f}))});
  const auto messageOfBuild = [] (const CompletedScene& scene, const PhysicsOptions& options) {
    return messageOf<InvalidArgument> ([&] { buildPhysicalScene (scene, options); });
  };
  CompletedScene bad = good;
  bad.objects[0].mesh.triangles.pop_back ();
  EXPECT_NE (messageOfBuild (bad, {}).find ("object 5: its mesh is not closed (3 open edges)"), std::string::npos);
  bad = good;
  for (auto& triangle : bad.objects[0].mesh.triangles)
    std::swap (triangle[0], triangle[1]);
  EXPECT_NE (messageOfBuild (bad, {}).find ("object 5: its mesh is turned inside out"), std::string::npos);
  EXPECT_NE (messageOfBuild (sceneOf ({}), {}).find ("no objects"), std::string::npos);

  const auto changed = [] (const std::function<void (PhysicsOptions&)>& change) {
    PhysicsOptions options;
    change (options);
    return options;
  };
  for (const double density : {0.0, -1.0, std::nan (""), std::numeric_limits<double>::infinity ()})
    EXPECT_NE (messageOfBuild (good, changed ([&] (auto& o) { o.density_kg_m3 = density; })).find ("density"),
               std::string::npos);
  EXPECT_NE (messageOfBuild (good, changed ([] (auto& o) { o.masses_kg[5] = 0.0; })).find ("the mass of object 5"),
             std::string::npos);
  EXPECT_NE (messageOfBuild (good, changed ([] (auto& o) { o.max_parts = 0; })).find ("part"), std::string::npos);
  EXPECT_NE (messageOfBuild (good, changed ([] (auto& o) { o.contact_tolerance_m = -1.0; })).find ("tolerance"),
             std::string::npos);
  EXPECT_NE (messageOfBuild (good, changed ([] (auto& o) { o.collision = CollisionShape::Outer; }))
                 .find ("object 5: has no outer bound"),
             std::string::npos);
}

/** \brief Bodies that are thinner than a voxel, or of which no voxel size is known, keep a volume. */
TEST (SceneInput, ThinBodiesAreNotMadeFlat)
{
  const auto card = [] (double below_m) {
    return objectOf (1, "card", boxMesh ({0.0f, 0.0f, 0.0f}, {0.08f, 0.05f, 0.001f}),
                     Eigen::Isometry3d (Eigen::Translation3d (0.0, 0.0, -below_m)));
  };
  CompletedObject unknown = objectOf (2, "brick", boxMesh ({0.2f, 0.0f, 0.0f}, {0.3f, 0.1f, 0.02f}));
  unknown.voxel_size_m = 0.0; // its edges are longer than it is high
  for (const CompletedObject& object : {card (-0.002), card (0.0), card (0.0007), unknown})
  {
    const PhysicalBody body = buildPhysicalScene (sceneOf ({object}), {}).bodies.at (0);
    EXPECT_EQ (body.stands_on, 0);
    EXPECT_GT (body.parts_volume_m3, 0.2 * body.volume_m3);
    EXPECT_LT (body.parts_volume_m3, 3.5 * body.volume_m3);
    EXPECT_EQ (body.feet.size (), 4u);
  }
  EXPECT_EQ (buildPhysicalScene (sceneOf ({card (0.0015)}), {}).bodies.at (0).stands_on, -1); // it is below the plane
}

TEST (SceneInput, IsTheSameForAnyNumberOfThreads)
{
  const CompletedScene completed = interlockingThings ();
  PhysicsOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const PhysicalScene first = buildPhysicalScene (completed, one), second = buildPhysicalScene (completed, two);
  const TemporaryFolder folder;
  std::filesystem::create_directory (folder.file ("1"));
  std::filesystem::create_directory (folder.file ("2"));
  const std::vector<std::string> files = writeMjcf (first, folder.file ("1"));
  const std::vector<std::string> again = writeMjcf (second, folder.file ("2"));
  ASSERT_EQ (files.size (), again.size ());
  for (std::size_t n = 0; n < files.size (); ++n)
    EXPECT_EQ (readFile (files[n]), readFile (again[n])) << files[n];
}

TEST (SceneInput, NoLengthInMetresDecides)
{
  for (const CompletedScene& completed : {fourThings (), interlockingThings ()})
  {
    const PhysicalScene scene = buildPhysicalScene (completed, {});
    for (const double factor :
         {1.0 / 128.0, 128.0}) // other factors round differently, and cuts of equal cost change places
    {
      PhysicsOptions options;
      options.contact_tolerance_m *= factor;
      const PhysicalScene scaled = buildPhysicalScene (scaledScene (completed, factor), options);
      for (std::size_t n = 0; n < scene.bodies.size (); ++n)
      {
        const PhysicalBody &body = scene.bodies[n], &other = scaled.bodies[n];
        EXPECT_EQ (other.parts.size (), body.parts.size ()) << body.name << " times " << factor;
        EXPECT_EQ (other.stands_on, body.stands_on) << body.name << " times " << factor;
        EXPECT_EQ (other.feet.size (), body.feet.size ()) << body.name << " times " << factor;
        EXPECT_NEAR (other.parts_volume_m3 / other.volume_m3, body.parts_volume_m3 / body.volume_m3, 1e-6) << body.name;
        EXPECT_NEAR (other.excess_m, factor * body.excess_m, 1e-6 * factor) << body.name;
      }
    }
  }
}

/** \brief How often some text is among the warnings of a scene. */
std::size_t
countOf (const PhysicalScene& scene, const std::string& part)
{
  return static_cast<std::size_t> (
      std::count_if (scene.warnings.begin (), scene.warnings.end (),
                     [&] (const std::string& text) { return text.find (part) != std::string::npos; }));
}

/** \brief A mesh of two, of which the second one may be turned inside out. */
TriangleMesh
joined (TriangleMesh first, const TriangleMesh& second, bool reversed)
{
  const auto offset = static_cast<std::uint32_t> (first.vertices.size ());
  first.vertices.insert (first.vertices.end (), second.vertices.begin (), second.vertices.end ());
  for (TriangleMesh::Triangle triangle : second.triangles)
  {
    if (reversed)
      std::swap (triangle[0], triangle[1]);
    first.triangles.push_back ({triangle[0] + offset, triangle[1] + offset, triangle[2] + offset});
  }
  return first;
}

TEST (SceneInput, OnlyWhatMatterCanBeHasAMass)
{
  const TriangleMesh box = boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f});
  const auto messageFor = [] (const TriangleMesh& mesh) {
    return messageOf<InvalidArgument> ([&] { buildPhysicalScene (sceneOf ({objectOf (7, "x", mesh)}), {}); });
  };
  EXPECT_NE (messageFor (boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.0f})).find ("object 7: its mesh has no volume"),
             std::string::npos);
  const TriangleMesh hole = boxMesh ({0.2f, 0.0f, 0.0f}, {0.3f, 0.1f, 0.099f});
  EXPECT_NE (messageFor (joined (box, hole, true)).find ("object 7: its mesh has no inertia"), std::string::npos);
  EXPECT_NE (messageFor (boxMesh ({0.0f, 0.0f, 0.0f}, {1000.0f, 1e-4f, 1e-4f})).find ("object 7: "), std::string::npos);

  const TriangleMesh cavity = boxMesh ({0.03f, 0.03f, 0.03f}, {0.07f, 0.07f, 0.07f});
  for (const TriangleMesh& mesh : {joined (box, hole, false), joined (box, cavity, true)})
    EXPECT_GT (buildPhysicalScene (sceneOf ({objectOf (7, "x", mesh)}), {}).bodies.at (0).mass_kg, 0.0);
}

TEST (SceneInput, LongNamesAreCut)
{
  const CompletedScene scene = sceneOf (
      {objectOf (3, std::string (5000, 'x'), boxMesh ({0, 0, 0}, {0.1f, 0.1f, 0.1f}))});
  const TemporaryFolder folder;
  EXPECT_NO_THROW (writeUrdf (buildPhysicalScene (scene, {}), folder.file ("")));
}

TEST (SceneInput, WarnsOfWhatASimulationWouldShow)
{
  const TriangleMesh box = boxMesh ({-0.05f, -0.05f, 0.0f}, {0.05f, 0.05f, 0.1f});
  const auto up = [] (double z) { return Eigen::Isometry3d (Eigen::Translation3d (0.0, 0.0, z)); };
  const PhysicalScene good = buildPhysicalScene (sceneOf ({objectOf (1, "a", box), objectOf (2, "b", box, up (0.1))}),
                                                 {});
  EXPECT_TRUE (good.warnings.empty ()) << good.warnings.front ();
  const PhysicalScene high = buildPhysicalScene (sceneOf ({objectOf (1, "a", box), objectOf (2, "b", box, up (0.5))}),
                                                 {});
  EXPECT_EQ (countOf (high, "b_2: will not stay"), 1u);
  EXPECT_EQ (high.warnings.size (), 1u);
  CompletedScene below = sceneOf ({objectOf (1, "a", box)});
  below.planes = {-floor_plane}; // turned the wrong way
  EXPECT_EQ (countOf (buildPhysicalScene (below, {}), "a_1: will not stay"), 1u);
  const PhysicalScene twice = buildPhysicalScene (sceneOf ({objectOf (1, "a", box), objectOf (2, "b", box)}), {});
  EXPECT_EQ (countOf (twice, "of its volume"), 2u);
  for (const double mass : {1e-16, 1e39})
  {
    PhysicsOptions options;
    options.masses_kg[1] = mass;
    EXPECT_EQ (countOf (buildPhysicalScene (sceneOf ({objectOf (1, "a", box)}), options), "which simulators refuse"),
               1u);
  }
  for (const double factor : {0.001, 20000.0})
    EXPECT_EQ (countOf (buildPhysicalScene (scaledScene (sceneOf ({objectOf (1, "a", box)}), factor), {}),
                        "which simulators may refuse"),
               1u);
}

TEST (SceneInput, WhatLeansIsNotMoved)
{
  const TriangleMesh box = boxMesh ({0.03f, 0.0f, 0.0f}, {0.12f, 0.05f, 0.07f});
  const CompletedScene scene = sceneOf ({objectOf (1, "arm", overhangingMesh ()), objectOf (2, "box", box)});
  for (const CollisionShape shape : {CollisionShape::Parts, CollisionShape::Mesh})
  {
    PhysicsOptions options;
    options.collision = shape;
    const PhysicalScene built = buildPhysicalScene (scene, options);
    EXPECT_EQ (built.bodies.at (0).centre_shift_m, 0.0);
  }
}

TEST (SceneInput, TheBackgroundNeedsNeitherVoxelSizeNorNumbers)
{
  CompletedScene scene = sceneOf ({objectOf (1, "a", boxMesh ({-0.05f, -0.05f, 0.0f}, {0.05f, 0.05f, 0.1f}))});
  scene.background = joined (boxMesh ({-0.5f, 0.5f, 0.0f}, {0.5f, 0.6f, 0.5f}),
                             boxMesh ({1.0f, 1.0f, 0.1f}, {2.0f, std::nanf (""), 0.5f}), false);
  for (const double voxel_m : {0.0, 1e-300, 0.002})
  {
    scene.objects[0].voxel_size_m = voxel_m;
    const PhysicalScene built = buildPhysicalScene (scene, {});
    ASSERT_EQ (built.bodies.size (), 2u);
    EXPECT_EQ (built.planes.at (0).endless, true);
    EXPECT_EQ (built.bodies[1].parts.empty (), voxel_m == 1e-300); // patches of this thickness are flat
  }
}

} // namespace
} // namespace pcl::cosection::test
