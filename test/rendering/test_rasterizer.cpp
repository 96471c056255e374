// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/small_meshes.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

PinholeCamera
testCamera ()
{
  PinholeCamera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = 140.0;
  camera.fy = 150.0;
  camera.cx = 77.3;
  camera.cy = 61.9;
  return camera;
}

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity ();

Eigen::Isometry3d
translation (double x, double y, double z)
{
  return Eigen::Isometry3d (Eigen::Translation3d (x, y, z));
}

/** \brief A parallelogram as two triangles: corner, corner + a, corner + a + b, corner + b. */
TriangleMesh
parallelogram (const Eigen::Vector3f& corner, const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  TriangleMesh mesh;
  mesh.vertices = {corner, corner + a, corner + a + b, corner + b};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/** \brief Range along the ray through pixel (u, v) at which it enters a sphere; NaN if it misses it. */
double
sphereDepth (const PinholeCamera& camera, int u, int v, const Eigen::Vector3d& centre, double radius)
{
  const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
  const double b = ray.dot (centre);
  return (b - std::sqrt (b * b - ray.squaredNorm () * (centre.squaredNorm () - radius * radius))) / ray.squaredNorm ();
}

int
covered (const RasterImage& image)
{
  int count = 0;
  for (const auto id : image.ids)
    count += (id >= 0);
  return count;
}

} // namespace

TEST (Rasterizer, DepthAndNormalOfATiltedPlaneAreThoseOfItsRays)
{
  const auto camera = testCamera ();
  const Eigen::Vector3f corner (-20, -20, 5);
  const Eigen::Vector3f a (40, 0, 8);
  const Eigen::Vector3f b (0, 40, -3);
  const Eigen::Vector3d n = b.cross (a).cast<double> ().normalized ();
  Rasterizer rasterizer (camera, identity);
  rasterizer.draw (parallelogram (corner, a, b), 7);
  const auto& image = rasterizer.image ();
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
      const double z = n.dot (corner.cast<double> ()) / n.dot (camera.unproject (u, v, 1.0));
      ASSERT_NEAR (image.depth[pixel], z, 1e-6 * z);
      ASSERT_EQ (image.ids[pixel], 7);
      ASSERT_NEAR (std::abs (n.dot (image.normals[pixel].cast<double> ())), 1.0, 1e-6);
      ASSERT_LT (image.normals[pixel].z (), 0.0f);
    }
}

class RasterizerOfSpheres : public ::testing::TestWithParam<std::uint32_t>
{};

TEST_P (RasterizerOfSpheres, DepthAndNormalAreThoseOfTheRays)
{
  const auto camera = testCamera ();
  const std::uint32_t n = GetParam ();
  const double radius = 0.3;
  const Eigen::Vector3d centre (0.05, -0.02, 1.0);
  Rasterizer rasterizer (camera, identity);
  rasterizer.draw (test::sphereMesh (radius, n), 0, translation (centre.x (), centre.y (), centre.z ()));
  const auto& image = rasterizer.image ();
  const double sagitta = radius * (1.0 - std::pow (std::cos (M_PI / (2 * n)), 2.0)); // between facets and sphere
  int checked = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
      const double z = sphereDepth (camera, u, v, centre, radius);
      if (std::isnan (z))
      {
        EXPECT_EQ (image.ids[pixel], -1);
        EXPECT_TRUE (std::isnan (image.depth[pixel]));
        continue;
      }
      const Eigen::Vector3d normal = (camera.unproject (u, v, z) - centre) / radius;
      const double cosine = -normal.dot (camera.unproject (u, v, 1.0).normalized ());
      if (cosine < 0.5)
        continue;
      ++checked;
      ASSERT_GE (image.depth[pixel], z - 1e-6);
      ASSERT_LE (image.depth[pixel], z + sagitta / cosine * 1.5 + 1e-6);
      ASSERT_GT (normal.dot (image.normals[pixel].cast<double> ()), 1.0 - 4.0 / (n * n));
    }
  EXPECT_GT (checked, 3000);
}

INSTANTIATE_TEST_SUITE_P (Tessellations, RasterizerOfSpheres, ::testing::Values (16u, 48u, 200u));

TEST (Rasterizer, TheNearestSurfaceWinsInWhateverOrder)
{
  const auto near_square = parallelogram ({-0.1f, -0.1f, 1.0f}, {0.2f, 0, 0}, {0, 0.2f, 0});
  const auto far_square = parallelogram ({-0.4f, -0.1f, 1.5f}, {0.8f, 0, 0}, {0, 0.2f, 0});
  for (const bool near_first : {true, false})
  {
    Rasterizer rasterizer (testCamera (), identity);
    rasterizer.draw (near_first ? near_square : far_square, near_first ? 1 : 2);
    rasterizer.draw (near_first ? far_square : near_square, near_first ? 2 : 1);
    const auto& image = rasterizer.image ();
    const auto pixel = [&] (double x, double y, double z) {
      const Eigen::Vector2d p = testCamera ().project ({x, y, z});
      return std::lround (p.y ()) * image.width + std::lround (p.x ());
    };
    EXPECT_EQ (image.ids[pixel (0, 0, 1)], 1);
    EXPECT_EQ (image.ids[pixel (0.3, 0, 1.5)], 2);
    EXPECT_EQ (image.ids[0], -1);
  }
}

TEST (Rasterizer, TrianglesOfOneEdgeNeitherOverlapNorLeaveGaps)
{
  // Fans about random points, among them pixel centres, so that edges go exactly through centres.
  const auto camera = testCamera ();
  std::mt19937 random (2);
  std::uniform_int_distribution<int> column (30, 120);
  std::uniform_int_distribution<int> row (30, 90);
  std::uniform_int_distribution<int> quarter (0, 3);
  for (int trial = 0; trial < 40; ++trial)
  {
    const int u0 = 10, u1 = 150, v0 = 10, v1 = 110;
    TriangleMesh mesh;
    const auto add = [&] (double u, double v) {
      mesh.vertices.push_back (camera.unproject (u, v, 1.0).cast<float> ());
    };
    add (column (random) + 0.25 * quarter (random), row (random) + 0.25 * quarter (random));
    for (const auto& [u, v] :
         {std::pair (u0, v0), {80, v0}, {u1, v0}, {u1, 60}, {u1, v1}, {80, v1}, {u0, v1}, {u0, 60}})
      add (u, v);
    std::vector<int> hits (static_cast<std::size_t> (camera.width) * camera.height, 0);
    for (std::uint32_t n = 0; n < 8; ++n)
    {
      TriangleMesh one = mesh;
      one.triangles = {{0, 1 + n, 1 + (n + 1) % 8}};
      if (n % 2 == 1)
        std::swap (one.triangles[0][1], one.triangles[0][2]); // orientation must not matter
      Rasterizer rasterizer (camera, identity);
      rasterizer.draw (one, 0);
      for (std::size_t pixel = 0; pixel < hits.size (); ++pixel)
        hits[pixel] += (rasterizer.image ().ids[pixel] == 0);
    }
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        const int expected = (u >= u0 && u < u1 && v >= v0 && v < v1);
        ASSERT_EQ (hits[static_cast<std::size_t> (v) * camera.width + u], expected) << u << " " << v;
      }
  }
}

TEST (Rasterizer, ClipsWhatReachesBehindTheCamera)
{
  // A floor that begins behind the camera and ends far away, wider than any picture.
  const auto camera = testCamera ();
  for (const float size : {10.0f, 1e3f, 1e6f})
  {
    Rasterizer rasterizer (camera, identity);
    rasterizer.draw (parallelogram ({-size, 1.0f, -size}, {2 * size, 0, 0}, {0, 0, 2 * size}), 3);
    const auto& image = rasterizer.image ();
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
        const double z = camera.fy / (v - camera.cy);
        const bool visible = z > 0.0 && z < size;
        ASSERT_EQ (image.ids[pixel], visible ? 3 : -1) << u << " " << v;
        if (visible)
        {
          ASSERT_NEAR (image.depth[pixel], z, 1e-5 * z) << u << " " << v;
        }
      }
  }
}

TEST (Rasterizer, NothingIsNearerThanTheNearPlane)
{
  Rasterizer rasterizer (testCamera (), identity, 0.5);
  rasterizer.draw (parallelogram ({-9, -9, 0.4f}, {18, 0, 0}, {0, 18, 0}), 1);
  EXPECT_EQ (covered (rasterizer.image ()), 0);
  rasterizer.draw (parallelogram ({-9, -9, 0.2f}, {18, 0, 0.6f}, {0, 18, 0}), 1);
  EXPECT_GT (covered (rasterizer.image ()), 0);
  for (const float z : rasterizer.image ().depth)
    EXPECT_TRUE (std::isnan (z) || z >= 0.5f);
}

TEST (Rasterizer, NormalsFaceTheCameraFromBothSides)
{
  auto mesh = parallelogram ({-9, -9, 2}, {18, 0, 0}, {0, 18, 0}); // its outer side faces away
  for (const bool smooth : {false, true})
  {
    if (smooth)
      mesh.normals.assign (4, {0, 0, 1});
    Rasterizer rasterizer (testCamera (), identity);
    rasterizer.draw (mesh, 0);
    for (const auto& n : rasterizer.image ().normals)
      ASSERT_LT ((n - Eigen::Vector3f (0, 0, -1)).norm (), 1e-6f);
  }
}

TEST (Rasterizer, TakesColoursFromTheMeshElseFromTheCall)
{
  auto mesh = parallelogram ({-9, -9, 2}, {18, 0, 0}, {0, 18, 0});
  Rasterizer plain (testCamera (), identity);
  plain.draw (mesh, 0, identity, {1, 2, 3});
  EXPECT_EQ (plain.image ().colours[500], (TriangleMesh::Colour{1, 2, 3}));
  mesh.colours = {{0, 9, 0}, {180, 9, 0}, {180, 9, 0}, {0, 9, 0}}; // red grows by 10 a metre
  Rasterizer coloured (testCamera (), identity);
  coloured.draw (mesh, 0, identity, {1, 2, 3});
  for (int u = 0; u < 160; ++u)
  {
    const double x = testCamera ().unproject (u, 20, 2.0).x ();
    EXPECT_NEAR (coloured.image ().colours[20 * 160 + u][0], 10.0 * (x + 9.0), 0.51);
    EXPECT_EQ (coloured.image ().colours[20 * 160 + u][1], 9);
  }
}

TEST (Rasterizer, PosesOfCameraAndMeshCancel)
{
  const Eigen::Isometry3d T = translation (1, -2, 3) * Eigen::AngleAxisd (0.7, Eigen::Vector3d (1, 1, 0).normalized ());
  const auto mesh = test::torusMesh (0.3, 0.1, 40, 20);
  Rasterizer here (testCamera (), identity);
  here.draw (mesh, 0, translation (0, 0, 1));
  Rasterizer there (testCamera (), T);
  there.draw (mesh, 0, T * translation (0, 0, 1));
  int differing = 0;
  for (std::size_t pixel = 0; pixel < here.image ().depth.size (); ++pixel)
  {
    const float expected = here.image ().depth[pixel];
    const float got = there.image ().depth[pixel];
    // A centre on a silhouette may fall on either side of it.
    differing += (std::isnan (expected) != std::isnan (got) || std::abs (got - expected) > 1e-4f);
  }
  EXPECT_LE (differing, 5);
}

TEST (Rasterizer, DrawsPointsAsSquares)
{
  const auto camera = testCamera ();
  const float nan = std::numeric_limits<float>::quiet_NaN ();
  const Eigen::Vector3d p = camera.unproject (50, 40, 2.0);
  Rasterizer rasterizer (camera, identity);
  rasterizer.drawPoints ({p.cast<float> (), {nan, 0, 1}, {0, 0, -1}, {1e9f, 0, 1}}, {}, 4, 3);
  const auto& image = rasterizer.image ();
  EXPECT_EQ (covered (image), 9);
  for (int v = 39; v <= 41; ++v)
    for (int u = 49; u <= 51; ++u)
    {
      EXPECT_EQ (image.ids[v * 160 + u], 4);
      EXPECT_FLOAT_EQ (image.depth[v * 160 + u], 2.0f);
      EXPECT_LT (image.normals[v * 160 + u].dot (p.normalized ().cast<float> ()), -0.9999f);
    }
  EXPECT_THROW (rasterizer.drawPoints ({{0, 0, 1}}, {{1, 2, 3}, {4, 5, 6}}, 0), InvalidArgument);
}

TEST (Rasterizer, SurvivesWhatIsNoNumber)
{
  const float nan = std::numeric_limits<float>::quiet_NaN ();
  const float inf = std::numeric_limits<float>::infinity ();
  TriangleMesh mesh;
  mesh.vertices = {{nan, 0, 1}, {0, 1, 1}, {1, 0, 1}, {inf, 0, 1}, {1e38f, -1e38f, 1e38f}, {-3e38f, 1, 1}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {1, 2, 4}, {2, 4, 5}, {1, 1, 2}, {6, 6, 6}, {6, 1, 2}};
  Rasterizer rasterizer (testCamera (), identity);
  EXPECT_NO_THROW (rasterizer.draw (mesh, 0));
  for (std::size_t pixel = 0; pixel < rasterizer.image ().ids.size (); ++pixel)
    EXPECT_EQ (std::isfinite (rasterizer.image ().depth[pixel]), rasterizer.image ().ids[pixel] == 0);
}

TEST (Rasterizer, RefusesBadInput)
{
  EXPECT_THROW (Rasterizer (PinholeCamera (), identity), InvalidArgument);
  EXPECT_THROW (Rasterizer (testCamera (), identity, 0.0), InvalidArgument);
  Rasterizer rasterizer (testCamera (), identity);
  TriangleMesh mesh;
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW (rasterizer.draw (mesh, 0), InvalidArgument);
}
