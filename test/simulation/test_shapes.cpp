// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/triangle_distance.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace pcl::cosection;

namespace {

constexpr double chord_m = 2e-5;

struct Case
{
  const char* name;
  std::function<Shape::ConstPtr ()> make;
  double volume_m3;
};

const Polygon2d cup{{0.0, 0.0}, {0.04, 0.0}, {0.04, 0.1}, {0.034, 0.1}, {0.034, 0.008}, {0.0, 0.008}};
const Polygon2d star{{0.1, 0.0},  {0.03, 0.02},   {0.02, 0.09}, {-0.02, 0.02},
                     {-0.1, 0.0}, {-0.02, -0.03}, {0.04, -0.1}, {0.03, -0.02}};

double
areaOf (const Polygon2d& p)
{
  double sum = 0.0;
  for (std::size_t n = 0; n < p.size (); ++n)
    sum += 0.5 * (p[n].x () * p[(n + 1) % p.size ()].y () - p[(n + 1) % p.size ()].x () * p[n].y ());
  return std::abs (sum);
}

double
roundedBoxVolume (double x, double y, double z, double r)
{
  const double a = x - 2 * r, b = y - 2 * r, c = z - 2 * r;
  return a * b * c + 2 * r * (a * b + b * c + c * a) + M_PI * r * r * (a + b + c) + 4.0 / 3.0 * M_PI * r * r * r;
}

class Shapes : public testing::TestWithParam<Case>
{};

const Case cases[] = {
    {"Sphere", [] { return makeSphere (0.06); }, 4.0 / 3.0 * M_PI* std::pow (0.06, 3)},
    {"Box",
     [] {
       return makeBox ({0.1, 0.06, 0.04});
     },
     0.1 * 0.06 * 0.04},
    {"RoundedBox",
     [] {
       return makeBox ({0.1, 0.06, 0.04}, 0.01);
     },
     roundedBoxVolume (0.1, 0.06, 0.04, 0.01)},
    {"Pill",
     [] {
       return makeBox ({0.1, 0.06, 0.04}, 0.02);
     },
     roundedBoxVolume (0.1, 0.06, 0.04, 0.02)},
    {"Cylinder", [] { return makeCylinder (0.03, 0.1); }, M_PI * 0.03 * 0.03 * 0.1},
    {"Cone", [] { return makeCone (0.04, 0.0, 0.1); }, M_PI * 0.04 * 0.04 * 0.1 / 3.0},
    {"Funnel", [] { return makeCone (0.0, 0.04, 0.1); }, M_PI * 0.04 * 0.04 * 0.1 / 3.0},
    {"Capsule", [] { return makeCapsule (0.02, 0.07); },
     M_PI * 0.02 * 0.02 * 0.07 + 4.0 / 3.0 * M_PI* std::pow (0.02, 3)},
    {"Torus", [] { return makeTorus (0.05, 0.015); }, 2.0 * M_PI* M_PI * 0.05 * 0.015 * 0.015},
    {"Cup", [] { return makeRevolution (cup); }, M_PI*(0.04 * 0.04 * 0.1 - 0.034 * 0.034 * 0.092)},
    {"Star", [] { return makeExtrusion (star, 0.05); }, areaOf (star) * 0.05},
};

} // namespace

TEST_P (Shapes, SurfaceIsClosedLiesOnZeroAndHasTheVolume)
{
  const Shape::ConstPtr shape = GetParam ().make ();
  EXPECT_TRUE (shape->isAnalytic ());
  const TriangleMesh mesh = shape->tessellate (chord_m);
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  EXPECT_NEAR (computeMassProperties (mesh).volume_m3 / GetParam ().volume_m3, 1.0, 3e-3);
  for (const Eigen::Vector3f& v : mesh.vertices)
    ASSERT_NEAR (shape->distance (v.cast<double> ()), 0.0, 1e-7);
  for (const auto& [a, b, c] : mesh.triangles)
  {
    const Eigen::Vector3f centre = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0f;
    ASSERT_NEAR (shape->distance (centre.cast<double> ()), 0.0, 1.05 * chord_m);
  }
}

TEST_P (Shapes, DistanceIsThatToTheSurface)
{
  const Shape::ConstPtr shape = GetParam ().make ();
  const TriangleMesh mesh = shape->tessellate (1e-4);
  std::mt19937 random (1);
  std::uniform_real_distribution<double> place (-0.12, 0.15);
  for (int n = 0; n < 40; ++n)
  {
    const Eigen::Vector3d p (place (random), place (random), place (random));
    EXPECT_NEAR (std::abs (shape->distance (p)), test::bruteForceSurfaceDistance (mesh, p), 1.5e-4) << p.transpose ();
  }
}

TEST_P (Shapes, SignSaysWhatIsInside)
{
  // By the divergence theorem: the share of a box that is negative is the volume.
  const Shape::ConstPtr shape = GetParam ().make ();
  constexpr int n = 130;
  constexpr double side = 0.26;
  int inside = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        const Eigen::Vector3d cell (i + 0.5, j + 0.5, k + 0.5);
        inside += shape->distance (side / n * cell - Eigen::Vector3d (0.13, 0.13, 0.11)) < 0.0;
      }
  EXPECT_NEAR (inside * std::pow (side / n, 3) / GetParam ().volume_m3, 1.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P (Analytic, Shapes, testing::ValuesIn (cases),
                          [] (const auto& info) { return info.param.name; });

TEST (Shape, RoomAndHalfSpaceAreMatterAround)
{
  EXPECT_NEAR (makeRoom ({4.0, 4.0, 2.0})->distance ({0.0, 0.0, 0.9}), 0.1, 1e-12);
  EXPECT_NEAR (makeRoom ({4.0, 4.0, 2.0})->distance ({0.0, 0.0, 1.2}), -0.2, 1e-12);
  EXPECT_LT (computeMassProperties (makeRoom ({1.0, 1.0, 1.0})->tessellate (0.001)).volume_m3, 0.0); // faces inward
  EXPECT_NEAR (makeHalfSpace (3.0)->distance ({7.0, 1.0, -0.25}), -0.25, 1e-12);
}

TEST (Shape, WrongSizesAreRefused)
{
  EXPECT_THROW (makeSphere (0.0), InvalidArgument);
  EXPECT_THROW (makeSphere (std::nan ("")), InvalidArgument);
  EXPECT_THROW (makeBox ({0.1, -0.1, 0.1}), InvalidArgument);
  EXPECT_THROW (makeBox ({0.1, 0.1, 0.1}, 0.06), InvalidArgument);
  EXPECT_THROW (makeTorus (0.02, 0.03), InvalidArgument);
  EXPECT_THROW (makeCone (0.0, 0.0, 0.1), InvalidArgument);
  EXPECT_THROW (makeRevolution ({{-0.1, 0.0}, {0.1, 0.0}, {0.1, 0.1}}), InvalidArgument);
  EXPECT_THROW (makeExtrusion ({{0.0, 0.0}, {0.1, 0.1}, {0.1, 0.0}, {0.0, 0.1}}, 0.1),
                InvalidArgument); // crosses itself
  EXPECT_THROW (makeExtrusion ({{0.0, 0.0}, {0.1, 0.0}, {0.2, 0.0}}, 0.1), InvalidArgument);
  EXPECT_THROW (makeExtrusion ({{0.0, 0.0}, {0.1, 0.0}}, 0.1), InvalidArgument);
  EXPECT_THROW (makeMeshShape ({}), InvalidArgument);
}

TEST (Shape, MeshHasItsOwnDistance)
{
  const Shape::ConstPtr ball = makeSphere (0.5);
  const Shape::ConstPtr mesh = makeMeshShape (ball->tessellate (1e-3), 0.1);
  EXPECT_FALSE (mesh->isAnalytic ());
  for (const Eigen::Vector3d& p : {Eigen::Vector3d (0.045, 0.0, 0.0), Eigen::Vector3d (0.0, 0.03, 0.042),
                                   Eigen::Vector3d (0.0, 0.0, -0.052), Eigen::Vector3d (0.04, 0.0, 0.0)})
    EXPECT_NEAR (mesh->distance (p), p.norm () - 0.05, 5e-4);
  EXPECT_LE (mesh->distance ({0.001, 0.0, 0.0}), -0.01);
  EXPECT_NEAR (mesh->distance ({0.3, 0.0, 0.0}), 0.25, 5e-3); // beyond the grid
}

TEST (SceneBody, UnionHasASurfaceWithoutWhatIsInside)
{
  SceneBody body;
  body.id = 1;
  body.parts = {{makeSphere (0.05)}, {makeSphere (0.05), Eigen::Isometry3d (Eigen::Translation3d (0.06, 0.0, 0.0))}};
  const TriangleMesh mesh = body.surface (chord_m);
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  EXPECT_EQ (computeTopology (mesh).components, 1);
  const double cap = 0.05 - 0.03;
  const double volume = 2.0 * (4.0 / 3.0 * M_PI * std::pow (0.05, 3) - M_PI * cap * cap / 3.0 * (3.0 * 0.05 - cap));
  EXPECT_NEAR (computeMassProperties (mesh).volume_m3 / volume, 1.0, 2e-3);
  double farthest = 0.0;
  for (const Eigen::Vector3f& v : mesh.vertices)
    farthest = std::max (farthest, std::abs (body.distance (v.cast<double> ())));
  EXPECT_LE (farthest, 3e-4); // where the balls meet; elsewhere on them
}
