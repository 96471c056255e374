// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/mesh_shape.h"
#include "common/small_meshes.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

/** \brief Largest distance of points on the triangles, not only of vertices, from the sphere about the origin. */
double
distanceFromSphere (const TriangleMesh& mesh, double radius)
{
  double farthest = 0.0;
  for (const auto& triangle : mesh.triangles)
  {
    const auto corners = test::cornersOf (mesh, triangle);
    for (const Eigen::Vector3d& weights :
         {Eigen::Vector3d (1, 0, 0), Eigen::Vector3d (0, 1, 0), Eigen::Vector3d (0.5, 0.5, 0),
          Eigen::Vector3d (0, 0.5, 0.5), Eigen::Vector3d (0.5, 0, 0.5), Eigen::Vector3d (0.33, 0.33, 0.34)})
      farthest = std::max (farthest, std::abs ((corners * weights).norm () - radius));
  }
  return farthest;
}

double
areaOf (const TriangleMesh& mesh)
{
  double area = 0.0;
  for (const auto& triangle : mesh.triangles)
    area += 0.5 * test::areaVectorOf (mesh, triangle).norm ();
  return area;
}

TriangleMesh
sphereAndTorus ()
{
  TriangleMesh mesh = test::sphereMesh (1.0, 14);
  TriangleMesh torus = test::torusMesh (0.5, 0.15, 30, 16);
  for (auto& v : torus.vertices)
    v.x () += 2.0f;
  appendMesh (mesh, torus);
  return mesh;
}

struct Solid
{
  const char* name;
  TriangleMesh mesh;
  std::size_t reachable; ///< upper limit of the smallest number of triangles
};

} // namespace

TEST (MeshDecimation, KeepsTheTopologyOfClosedMeshes)
{
  // A tetrahedron is the smallest sphere; the smallest torus has 14 triangles, but not without self-intersection.
  const std::vector<Solid> solids = {{"sphere", test::sphereMesh (1.0, 20), 4},
                                     {"torus", test::torusMesh (1.0, 0.3, 40, 20), 24},
                                     {"box", test::subdivided (test::boxMesh ({0, 0, 0}, {3, 2, 1}), 4), 4},
                                     {"sphere and torus", sphereAndTorus (), 28}};
  for (const Solid& solid : solids)
    for (const std::size_t target : {1200, 600, 301, 150, 100, 60, 40, 28, 24, 12, 6, 4, 1})
    {
      SCOPED_TRACE (std::string (solid.name) + " to " + std::to_string (target));
      const TriangleMesh result = decimate (solid.mesh, target);
      EXPECT_LE (result.triangles.size (), std::max (target, solid.reachable));
      EXPECT_GE (result.triangles.size () + 1, std::min (target, solid.mesh.triangles.size ()));
      test::expectSameTopology (result, solid.mesh);
      EXPECT_GT (computeMassProperties (result).volume_m3, 0.0);
      for (const auto& v : result.vertices)
        ASSERT_TRUE (v.allFinite ());
    }
}

TEST (MeshDecimation, LosesNoComponent)
{
  TriangleMesh mesh;
  for (int n = 0; n < 5; ++n)
    appendMesh (mesh, test::subdivided (test::boxMesh ({2.0f * n, 0, 0}, {2.0f * n + 0.01f * (n + 1), 1, 1}), 2));
  const TriangleMesh result = decimate (mesh, 1);
  EXPECT_EQ (result.triangles.size (), 5u * 4u); // tetrahedra
  test::expectSameTopology (result, mesh);
  EXPECT_EQ (decimate (result, 1).triangles, result.triangles);
}

TEST (MeshDecimation, OfASphereKeepsVolumeAndDistance)
{
  const TriangleMesh sphere = test::sphereMesh (1.0, 71);
  ASSERT_GT (sphere.triangles.size (), 19000u);
  const double volume = computeMassProperties (sphere).volume_m3;
  for (const std::size_t target : {5000, 1000, 300})
  {
    const TriangleMesh result = decimate (sphere, target);
    EXPECT_EQ (result.triangles.size (), target);
    const auto mass = computeMassProperties (result);
    EXPECT_NEAR (mass.volume_m3 / volume, 1.0, 10.0 / target);
    EXPECT_LT (mass.centroid_m.norm (), 0.01);
    // Equilateral triangles with corners on the sphere would be 4.8 / target below it in their middle.
    EXPECT_LT (distanceFromSphere (result, 1.0), 12.0 / target);
    for (const auto& triangle : result.triangles)
    {
      const Eigen::Vector3d outward = test::cornersOf (result, triangle).rowwise ().sum ().normalized ();
      EXPECT_GT (test::areaVectorOf (result, triangle).normalized ().dot (outward), 0.8);
      EXPECT_GT (test::qualityOf (result, triangle), 0.1);
    }
  }
}

TEST (MeshDecimation, FindsTheCornersOfABox)
{
  // Also a plate: its thickness must outlast the triangles of its large faces.
  for (const Eigen::Vector3f& size : {Eigen::Vector3f (3, 2, 1), Eigen::Vector3f (1, 1, 0.02f)})
  {
    const Eigen::Vector3f lower (0.3f, -1.7f, 0.9f);
    const TriangleMesh box = test::boxMesh (lower, lower + size);
    const TriangleMesh result = decimate (test::subdivided (box, 4), 12);
    ASSERT_EQ (result.triangles.size (), 12u);
    EXPECT_TRUE (computeTopology (result).closed_manifold);
    EXPECT_NEAR (computeMassProperties (result).volume_m3 / computeMassProperties (box).volume_m3, 1.0, 1e-5);
    for (const auto& corner : box.vertices)
    {
      const auto at_corner = [&] (const Eigen::Vector3f& v) { return (v - corner).norm () < 1e-5f; };
      EXPECT_EQ (std::count_if (result.vertices.begin (), result.vertices.end (), at_corner), 1);
    }
  }
}

TEST (MeshDecimation, KeepsTheBoundaryOfASheet)
{
  const TriangleMesh sheet = test::sheetMesh (20, [] (double, double) { return true; });
  for (const std::size_t target : {200, 50, 10, 2})
  {
    const TriangleMesh result = decimate (sheet, target);
    EXPECT_LE (result.triangles.size (), target);
    test::expectSameTopology (result, sheet);
    EXPECT_NEAR (areaOf (result), 1.0, 1e-5);
    for (const auto& triangle : result.triangles)
      EXPECT_GT (test::areaVectorOf (result, triangle).z (), 0.0);
  }
  test::expectSameTopology (decimate (sheet, 1), sheet); // a triangle is left
}

TEST (MeshDecimation, KeepsHolesApart)
{
  // Two square holes beside each other, as bands of one cell between and around them would let boundaries touch.
  const TriangleMesh sheet = test::sheetMesh (18, [] (double x, double y) {
    return std::min (std::abs (x - 0.27), std::abs (x - 0.73)) > 0.2 || std::abs (y - 0.5) > 0.3;
  });
  ASSERT_EQ (computeTopology (sheet).euler, -1);
  for (const std::size_t target : {200, 60, 30, 14, 1})
  {
    const TriangleMesh result = decimate (sheet, target);
    test::expectSameTopology (result, sheet);
    if (target < 30)
      continue;
    EXPECT_LE (result.triangles.size (), target);
    EXPECT_NEAR (areaOf (result), areaOf (sheet), 1e-4);
  }
}

TEST (MeshDecimation, CarriesAttributes)
{
  TriangleMesh mesh = test::sphereMesh (1.0, 40);
  const auto brightness = [] (const Eigen::Vector3f& v) { return 0.5f + 0.4f * v.x (); };
  for (const auto& v : mesh.vertices)
  {
    mesh.confidence.push_back (brightness (v));
    mesh.sigma_m.push_back (0.01f * brightness (v));
    mesh.colours.push_back ({static_cast<std::uint8_t> (std::lround (255 * brightness (v))), 7, 200});
    mesh.provenance.push_back (static_cast<std::uint8_t> (v.z () > 0.0f ? Provenance::Observed : Provenance::Hull));
  }
  const TriangleMesh result = decimate (mesh, 1500);
  const std::size_t n = result.vertices.size ();
  ASSERT_EQ (result.normals.size (), n);
  ASSERT_EQ (result.confidence.size (), n);
  ASSERT_EQ (result.sigma_m.size (), n);
  ASSERT_EQ (result.colours.size (), n);
  ASSERT_EQ (result.provenance.size (), n);
  for (std::size_t v = 0; v < n; ++v)
  {
    const Eigen::Vector3f& p = result.vertices[v];
    EXPECT_NEAR (result.confidence[v], brightness (p), 0.03f);
    EXPECT_NEAR (result.sigma_m[v], 0.01f * brightness (p), 0.0003f);
    EXPECT_NEAR (result.colours[v][0], 255 * brightness (p), 0.03f * 255);
    EXPECT_EQ (result.colours[v][1], 7);
    EXPECT_EQ (result.colours[v][2], 200);
    EXPECT_NEAR (result.normals[v].norm (), 1.0f, 1e-5f);
    EXPECT_GT (result.normals[v].dot (p.normalized ()), 0.99f);
    const Provenance of_its_side = (p.z () > 0.0f ? Provenance::Observed : Provenance::Hull);
    EXPECT_TRUE (std::abs (p.z ()) < 0.1f || result.provenance[v] == static_cast<std::uint8_t> (of_its_side));
  }
}

TEST (MeshDecimation, LeavesEmptyArraysEmpty)
{
  TriangleMesh mesh = test::sphereMesh (1.0, 8);
  mesh.normals.clear ();
  mesh.vertices.push_back (Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ())); // not used
  const TriangleMesh result = decimate (mesh, 100);
  EXPECT_EQ (result.triangles.size (), 100u);
  EXPECT_EQ (result.vertices.size (), 52u);
  EXPECT_TRUE (result.normals.empty ());
  EXPECT_TRUE (result.colours.empty ());
  EXPECT_TRUE (result.confidence.empty ());
  EXPECT_TRUE (result.sigma_m.empty ());
  EXPECT_TRUE (result.provenance.empty ());
}

TEST (MeshDecimation, ReturnsSmallMeshesAsTheyAre)
{
  TriangleMesh mesh = test::torusMesh (1.0, 0.3, 12, 7);
  mesh.confidence.assign (mesh.vertices.size (), 0.25f);
  for (const std::size_t target : {mesh.triangles.size (), mesh.triangles.size () + 1000})
  {
    const TriangleMesh result = decimate (mesh, target);
    EXPECT_EQ (result.triangles, mesh.triangles);
    EXPECT_EQ (result.vertices, mesh.vertices);
    EXPECT_EQ (result.normals, mesh.normals);
    EXPECT_EQ (result.confidence, mesh.confidence);
  }
  EXPECT_TRUE (decimate (TriangleMesh (), 5).empty ());
}

TEST (MeshDecimation, IsTheSameAgainAndAtAnyScale)
{
  const TriangleMesh mesh = sphereAndTorus ();
  const TriangleMesh first = decimate (mesh, 150);
  const TriangleMesh second = decimate (mesh, 150);
  EXPECT_EQ (second.triangles, first.triangles);
  EXPECT_EQ (second.vertices, first.vertices);
  EXPECT_EQ (second.normals, first.normals);
  for (const float scale : {std::ldexp (1.0f, -30), std::ldexp (1.0f, 30)}) // exact
  {
    TriangleMesh scaled = mesh;
    for (auto& v : scaled.vertices)
      v *= scale;
    const TriangleMesh result = decimate (scaled, 150);
    EXPECT_EQ (result.triangles, first.triangles);
    ASSERT_EQ (result.vertices.size (), first.vertices.size ());
    for (std::size_t v = 0; v < result.vertices.size (); ++v)
      EXPECT_LE ((result.vertices[v] - scale * first.vertices[v]).norm (), 1e-5f * scale);
  }
}

TEST (MeshDecimation, WorksFarFromTheOrigin)
{
  TriangleMesh mesh = test::sphereMesh (0.1, 40);
  for (auto& v : mesh.vertices)
    v += Eigen::Vector3f (100, -50, 20);
  const double volume = computeMassProperties (mesh).volume_m3;
  for (const std::size_t target : {1000, 200})
  {
    const TriangleMesh result = decimate (mesh, target);
    EXPECT_EQ (result.triangles.size (), target);
    test::expectSameTopology (result, mesh);
    EXPECT_NEAR (computeMassProperties (result).volume_m3 / volume, 1.0, 10.0 / target);
  }
}

TEST (MeshDecimation, RemovesTrianglesWithoutArea)
{
  // Rounded to a grid, many vertices coincide and many triangles are lines or points.
  const float grid = 0.125f;
  TriangleMesh mesh = test::sphereMesh (1.0, 50);
  for (auto& v : mesh.vertices)
    v = (v / grid).array ().round ().matrix () * grid;
  const auto degenerate = [] (const TriangleMesh& m) {
    return std::count_if (m.triangles.begin (), m.triangles.end (),
                          [&m] (const TriangleMesh::Triangle& t) { return test::qualityOf (m, t) < 1e-3; });
  };
  ASSERT_GT (degenerate (mesh), 1000);
  const TriangleMesh result = decimate (mesh, 1000);
  EXPECT_EQ (result.triangles.size (), 1000u);
  EXPECT_EQ (degenerate (result), 0);
  test::expectSameTopology (result, mesh);
  EXPECT_NEAR (computeMassProperties (result).volume_m3 / computeMassProperties (mesh).volume_m3, 1.0, 0.01);
}

TEST (MeshDecimation, LetsNormalsTurnNoFurtherThanAllowed)
{
  // A subdivided box cannot lose its corners if no normal may turn.
  DecimationOptions options;
  options.max_triangles = 1;
  options.max_normal_turn_deg = 1.0;
  const TriangleMesh result = decimate (test::subdivided (test::boxMesh ({0, 0, 0}, {1, 1, 1}), 3), options);
  EXPECT_EQ (result.triangles.size (), 12u);
  EXPECT_NEAR (computeMassProperties (result).volume_m3, 1.0, 1e-6);
}

TEST (MeshDecimation, RefusesWhatIsNoManifold)
{
  auto flipped = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  std::swap (flipped.triangles[3][0], flipped.triangles[3][1]);
  EXPECT_THROW (decimate (flipped, 8), InvalidArgument);
  EXPECT_EQ (decimate (flipped, 12).triangles, flipped.triangles);

  auto touching = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  appendMesh (touching, test::boxMesh ({1, 1, 1}, {2, 2, 2}));
  for (auto& t : touching.triangles)
    for (auto& v : t)
      v = (v == 8 ? 7 : v);
  EXPECT_THROW (decimate (touching, 20), InvalidArgument);

  auto repeated = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  repeated.triangles.push_back ({2, 2, 3});
  EXPECT_THROW (decimate (repeated, 8), InvalidArgument);
}

TEST (MeshDecimation, RefusesBadInput)
{
  const TriangleMesh mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW (decimate (mesh, 0), InvalidArgument);
  EXPECT_THROW (decimate (mesh, DecimationOptions ()), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN ();
  const auto refused = [&] (double turn, double quality, double boundary) {
    EXPECT_THROW (decimate (mesh, DecimationOptions{8, turn, quality, boundary}), InvalidArgument);
  };
  for (const double bad : {-1.0, nan})
  {
    refused (bad, 0.1, 10.0);
    refused (80.0, bad, 10.0);
    refused (80.0, 0.1, bad);
  }
  refused (91.0, 0.1, 10.0);
  refused (80.0, 1.1, 10.0);
  EXPECT_NO_THROW (decimate (mesh, DecimationOptions{8, 90.0, 0.0, 0.0}));

  auto broken = mesh;
  broken.vertices[3].y () = static_cast<float> (nan);
  EXPECT_THROW (decimate (broken, 8), InvalidArgument);
  broken = mesh;
  broken.triangles[5][1] = 8;
  EXPECT_THROW (decimate (broken, 8), InvalidArgument);
  EXPECT_THROW (decimate (broken, 100), InvalidArgument);
  broken = mesh;
  broken.confidence.resize (3);
  EXPECT_THROW (decimate (broken, 8), InvalidArgument);
}

TEST (Decimation, ThinWallsAreNotTurnedInsideOut)
{
  for (const double thickness : {0.01, 0.03})
  {
    const TriangleMesh shell = test::shellMesh (thickness);
    const double volume = computeMassProperties (shell).volume_m3;
    ASSERT_GT (volume, 0.0);
    for (const std::size_t faces : {4, 10, 20, 40, 100, 400})
    {
      const TriangleMesh small = decimate (shell, faces);
      EXPECT_TRUE (computeTopology (small).closed_manifold) << faces;
      EXPECT_GT (computeMassProperties (small).volume_m3, 0.1 * volume) << faces;
      EXPECT_LT (small.triangles.size (), shell.triangles.size ()) << faces;
    }
  }
}
