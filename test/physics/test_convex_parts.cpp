// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Convex hulls, division into convex parts, and how these touch each other and the ground.

#include "physical_scenes.h"

#include "common/mesh_shape.h"
#include "common/temporary_folder.h"
#include "pcl_cosection/physics/clipped_mesh.h"
#include "pcl_cosection/physics/convex_decomposition.h"
#include "pcl_cosection/physics/part_contacts.h"
#include "pcl_cosection/physics/resting.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace pcl::cosection::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points
randomPoints (std::size_t count, unsigned seed)
{
  std::mt19937 generator (seed);
  std::uniform_real_distribution<double> number (-1.0, 1.0);
  Points points;
  for (std::size_t n = 0; n < count; ++n)
    points.emplace_back (number (generator), number (generator), number (generator));
  return points;
}

Points
movedPoints (Points points, const Eigen::Affine3d& T)
{
  for (Eigen::Vector3d& p : points)
    p = T * p;
  return points;
}

Eigen::Isometry3d
someTurn ()
{
  return Eigen::Translation3d (0.3, -0.2, 0.5) *
         Eigen::AngleAxisd (1.1, Eigen::Vector3d (0.4, -0.7, 0.3).normalized ());
}

/** \brief Corners of the box around the origin. */
Points
boxCorners (const Eigen::Vector3d& half)
{
  Points corners;
  for (int n = 0; n < 8; ++n)
    corners.emplace_back ((n & 1) != 0 ? half.x () : -half.x (), (n & 2) != 0 ? half.y () : -half.y (),
                          (n & 4) != 0 ? half.z () : -half.z ());
  return corners;
}

/** \brief Closed, convex, and what its fields say. */
void
expectHull (const ConvexHull& hull, double size_m)
{
  const TriangleMesh mesh = hull.mesh ();
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  EXPECT_EQ (computeTopology (mesh).euler, 2);
  EXPECT_NEAR (hull.volume_m3, computeMassProperties (mesh).volume_m3, 1e-5 * hull.volume_m3);
  ASSERT_EQ (hull.planes.size (), hull.triangles.size ());
  for (std::size_t n = 0; n < hull.planes.size (); ++n)
  {
    const Eigen::Vector3d normal = hull.planes[n].head<3> ();
    EXPECT_NEAR (normal.norm (), 1.0, 1e-12);
    for (const std::uint32_t v : hull.triangles[n])
      EXPECT_NEAR (normal.dot (hull.corners[v]) + hull.planes[n][3], 0.0, 1e-12 * size_m);
    EXPECT_GE (normal.dot (areaVectorOf (mesh, mesh.triangles[n])), 0.0);
  }
  for (const Eigen::Vector3d& corner : hull.corners)
    EXPECT_NEAR (hull.depthOf (corner), 0.0, 1e-12 * size_m);
}

double
sumOfVolumes (const std::vector<ConvexHull>& hulls)
{
  return std::accumulate (hulls.begin (), hulls.end (), 0.0,
                          [] (double sum, const ConvexHull& hull) { return sum + hull.volume_m3; });
}

/** \brief An H of 3 x 3 squares, 5 cm thick, standing. */
TriangleMesh
letterH ()
{
  TriangleMesh mesh = makeExtrusion ({{0.0, 0.0},
                                      {0.03, 0.0},
                                      {0.03, 0.03},
                                      {0.06, 0.03},
                                      {0.06, 0.0},
                                      {0.09, 0.0},
                                      {0.09, 0.09},
                                      {0.06, 0.09},
                                      {0.06, 0.06},
                                      {0.03, 0.06},
                                      {0.03, 0.09},
                                      {0.0, 0.09}},
                                     0.05)
                          ->tessellate (chord_m);
  return withoutNormals (std::move (mesh));
}

// --- Hulls ---

TEST (ConvexHull3d, ContainsItsPointsAndIsClosed)
{
  for (const std::size_t count : {4u, 10u, 100u, 3000u})
    for (const double scale : {1e-3, 1.0, 1e3})
    {
      const Points points = movedPoints (randomPoints (count, 7), Eigen::Affine3d (Eigen::Scaling (scale)));
      const ConvexHull hull = convexHullOf (points);
      ASSERT_FALSE (hull.empty ()) << count << " points, scale " << scale;
      expectHull (hull, scale);
      for (const Eigen::Vector3d& p : points)
        EXPECT_GE (hull.depthOf (p), -1e-12 * scale);
      for (const Eigen::Vector3d& corner : hull.corners)
        EXPECT_NE (std::find (points.begin (), points.end (), corner), points.end ());
    }
}

TEST (ConvexHull3d, OfABoxHasItsVolumeCornersAndDepths)
{
  Points points = boxCorners ({0.1, 0.2, 0.3});
  for (const Eigen::Vector3d& inner : randomPoints (50, 3)) // inside, on faces, and twice
    points.push_back (inner.cwiseProduct (Eigen::Vector3d (0.1, 0.2, 0.3)));
  points.emplace_back (0.1, 0.05, -0.2);
  points.insert (points.end (), points.begin (), points.begin () + 8);
  const ConvexHull hull = convexHullOf (movedPoints (points, someTurn ()));
  expectHull (hull, 1.0);
  EXPECT_NEAR (hull.volume_m3, 8.0 * 0.1 * 0.2 * 0.3, 1e-12);
  EXPECT_NEAR (hull.depthOf (someTurn ().translation ()), 0.1, 1e-12);
  EXPECT_NEAR (hull.depthOf (someTurn () * Eigen::Vector3d (0.15, 0.0, 0.0)), -0.05, 1e-12);
}

TEST (ConvexHull3d, OfWhatHasNoVolumeIsEmpty)
{
  Points flat = randomPoints (100, 5), collinear = flat;
  for (Eigen::Vector3d& p : flat)
    p.z () = 0.25;
  for (Eigen::Vector3d& p : collinear)
    p = p.x () * Eigen::Vector3d (0.3, -0.5, 0.7);
  for (const Points& points : {Points (), Points (3, Eigen::Vector3d (1, 2, 3)), Points (20, Eigen::Vector3d (1, 2, 3)),
                               flat, collinear, movedPoints (flat, someTurn ())})
  {
    const ConvexHull hull = convexHullOf (points);
    EXPECT_TRUE (hull.empty ());
    EXPECT_TRUE (hull.corners.empty ());
    EXPECT_EQ (hull.volume_m3, 0.0);
    EXPECT_TRUE (hull.mesh ().empty ());
  }
}

// --- Clipping ---

TEST (ClippedMesh, APlaneDividesTheSurface)
{
  const MeshPiece box = pieceOf (boxMesh ({-1, -1, -1}, {1, 1, 1}));
  const auto areaOf = [] (const MeshPiece& piece) {
    double area = 0.0;
    for (const auto& t : piece.triangles)
      area += 0.5 *
              (piece.vertices[t[1]] - piece.vertices[t[0]]).cross (piece.vertices[t[2]] - piece.vertices[t[0]]).norm ();
    return area;
  };
  for (const Eigen::Vector4d& plane :
       {Eigen::Vector4d (1, 0, 0, -0.25), Eigen::Vector4d (0.6, 0.0, 0.8, 0.1), Eigen::Vector4d (0, 0, 1, -1)})
  {
    const MeshPiece behind = pieceBehind (box, plane), before = pieceBehind (box, -plane);
    for (const Eigen::Vector3d& p : behind.vertices)
      EXPECT_LE (plane.head<3> ().dot (p) + plane[3], 1e-12);
    EXPECT_NEAR (areaOf (behind) + areaOf (before), 24.0, plane[3] == -1.0 ? 4.0 : 1e-9); // a face may be on both sides
    EXPECT_NEAR (convexHullOf (pointsBehind (box, plane)).volume_m3, convexHullOf (behind.vertices).volume_m3, 1e-12);
  }
  EXPECT_NEAR (areaOf (pieceBehind (box, {1, 0, 0, -0.25})), 4.0 + 4.0 * 2.0 * 1.25, 1e-9);
  EXPECT_TRUE (pieceBehind (box, {1, 0, 0, 2}).triangles.empty ());
  EXPECT_TRUE (pointsBehind (box, {1, 0, 0, 2}).empty ());
}

TEST (ClippedMesh, WindingNumberIsOneInsideOnly)
{
  const TriangleMesh torus = torusMesh (0.5, 0.2, 40, 20);
  const WindingNumber winding (torus);
  EXPECT_NEAR (winding ({0.5, 0.0, 0.0}), 1.0, 1e-5);
  EXPECT_NEAR (winding ({0.0, -0.45, 0.1}), 1.0, 1e-5);
  EXPECT_NEAR (winding ({0.0, 0.0, 0.0}), 0.0, 1e-5); // the hole
  EXPECT_NEAR (winding ({1.0, 1.0, 1.0}), 0.0, 1e-5);
}

TEST (ClippedMesh, CornersOfPlanesInsideTheBodyCount)
{
  const TriangleMesh box = boxMesh ({-1, -1, -1}, {1, 1, 1});
  const WindingNumber winding (box);
  const std::vector<Eigen::Vector4d> octant = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  EXPECT_NEAR (convexHullOf (pointsBetween (box, octant, winding)).volume_m3, 1.0, 1e-9); // without (0, 0, 0): 5 / 6
  std::vector<Eigen::Vector4d> outside = octant;
  for (Eigen::Vector4d& plane : outside)
    plane[3] = -3.0;
  EXPECT_NEAR (convexHullOf (pointsBetween (box, outside, winding)).volume_m3, 8.0, 1e-9);
  EXPECT_TRUE (pointsBetween (box, {{1, 0, 0, 3}}, winding).empty ());
}

// --- Division ---

TEST (ConvexDecomposition, ConvexBodiesStayWhole)
{
  const ConvexDecompositionOptions options;
  for (const TriangleMesh& mesh : {boxMesh ({0, 0, 0}, {0.1f, 0.2f, 0.3f}), sphereMesh (0.05, 20), canMesh (0.03, 0.1)})
  {
    const std::vector<ConvexHull> parts = decomposeConvex (mesh, options);
    EXPECT_EQ (parts.size (), 1u);
    EXPECT_NEAR (sumOfVolumes (parts), computeMassProperties (mesh).volume_m3,
                 1e-4 * computeMassProperties (mesh).volume_m3);
  }
}

TEST (ConvexDecomposition, PartsOfAnHAreItsBars)
{
  const TriangleMesh mesh = letterH ();
  const std::vector<ConvexHull> parts = decomposeConvex (mesh, {});
  EXPECT_LE (parts.size (), 7u);
  EXPECT_GE (parts.size (), 3u);
  EXPECT_LE (farthestOutside (parts, mesh, Eigen::Isometry3d::Identity ()), 1e-9);
  EXPECT_LE (sumOfVolumes (parts), 1.06 * computeMassProperties (mesh).volume_m3);
  EXPECT_LT (depthIn (parts, {0.045, 0.01, 0.025}), -0.005); // between the legs
}

TEST (ConvexDecomposition, ATorusKeepsItsHole)
{
  const TriangleMesh mesh = torusMesh (0.06, 0.02, 60, 24);
  const double volume = computeMassProperties (mesh).volume_m3;
  double before = std::numeric_limits<double>::infinity ();
  for (const int max_parts : {1, 4, 8, 16, 32})
  {
    ConvexDecompositionOptions options;
    options.max_parts = max_parts;
    const std::vector<ConvexHull> parts = decomposeConvex (mesh, options);
    EXPECT_LE (parts.size (), static_cast<std::size_t> (max_parts));
    EXPECT_LE (farthestOutside (parts, mesh, Eigen::Isometry3d::Identity ()), 1e-9);
    EXPECT_GE (sumOfVolumes (parts), 0.999 * volume);
    EXPECT_LT (sumOfVolumes (parts), 1.02 * before) << max_parts;
    before = sumOfVolumes (parts);
    for (const ConvexHull& part : parts)
      expectHull (part, 0.1);
    if (max_parts >= 8)
    {
      EXPECT_LT (depthIn (parts, Eigen::Vector3d::Zero ()), 0.0);
    }
  }
  EXPECT_LT (before, 1.15 * volume);
}

TEST (ConvexDecomposition, StaysOutOfPlacesToAvoid)
{
  // A ball in a cup, whose walls are a little too thick if nothing is said of the ball.
  const auto ball = movedMesh (withoutNormals (sphereMesh (0.025, 20)),
                               Eigen::Isometry3d (Eigen::Translation3d (0.0, 0.0, cup_wall_m + 0.025)));
  ConvexDecompositionOptions options;
  options.tolerance_m = 0.0002;
  for (const Eigen::Vector3f& vertex : ball.vertices)
    options.avoid.push_back (vertex.cast<double> ());
  const std::vector<ConvexHull> parts = decomposeConvex (cupMesh (), options);
  for (const Eigen::Vector3d& p : options.avoid)
    EXPECT_LE (depthIn (parts, p), options.tolerance_m);
  EXPECT_LE (farthestOutside (parts, cupMesh (), Eigen::Isometry3d::Identity ()), 1e-9);
  EXPECT_LE (parts.size (), static_cast<std::size_t> (options.max_parts));
}

TEST (ConvexDecomposition, PlacesToAvoidMakeNothingWorse)
{
  // A ring around a thick column: its parts stay out of that anyway.
  const TriangleMesh mesh = torusMesh (0.06, 0.02, 60, 24);
  ConvexDecompositionOptions options;
  options.tolerance_m = 0.0002;
  const std::vector<ConvexHull> plain = decomposeConvex (mesh, options);
  for (const Eigen::Vector3d& p : randomPoints (600, 9))
    if (p.head<2> ().norm () < 1.0)
      options.avoid.push_back (p.cwiseProduct (Eigen::Vector3d (0.037, 0.037, 0.02)));
  const std::vector<ConvexHull> parts = decomposeConvex (mesh, options);
  EXPECT_LE (sumOfVolumes (parts), 1.0001 * sumOfVolumes (plain));
  for (const Eigen::Vector3d& p : options.avoid)
    EXPECT_LE (depthIn (parts, p), options.tolerance_m);
}

TEST (ConvexDecomposition, IsTheSameForAnyNumberOfThreads)
{
  ConvexDecompositionOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const std::vector<ConvexHull> first = decomposeConvex (cupMesh (), one), second = decomposeConvex (cupMesh (), two);
  ASSERT_EQ (first.size (), second.size ());
  for (std::size_t n = 0; n < first.size (); ++n)
  {
    EXPECT_EQ (first[n].corners, second[n].corners);
    EXPECT_EQ (first[n].triangles, second[n].triangles);
  }
}

TEST (ConvexDecomposition, RefusesWhatItCannotDivide)
{
  ConvexDecompositionOptions none;
  none.max_parts = 0;
  const TriangleMesh box = boxMesh ({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW (decomposeConvex (box, none), InvalidArgument);
  TriangleMesh open = box, reversed = box;
  open.triangles.pop_back ();
  for (auto& triangle : reversed.triangles)
    std::swap (triangle[0], triangle[1]);
  for (const TriangleMesh& mesh : {open, reversed, TriangleMesh ()})
    EXPECT_THROW (decomposeConvex (mesh, {}), InvalidArgument);
  ConvexDecompositionOptions options;
  options.max_excess = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (decomposeConvex (box, options), InvalidArgument);
  options = {};
  options.tolerance_m = -1.0;
  EXPECT_THROW (decomposeConvex (box, options), InvalidArgument);
}

TEST (ConvexDecomposition, AFlatBodyTakesNoMoreMemoryThanAThickOne)
{
  const std::vector<ConvexHull> parts = decomposeConvex (boxMesh ({0, 0, 0}, {10.0f, 10.0f, 1e-6f}), {});
  ASSERT_EQ (parts.size (), 1u);
  EXPECT_NEAR (parts[0].volume_m3, 1e-4, 1e-9);
}

TEST (ConvexHull3d, IsNotSolidIfRoundingMakesItFlat)
{
  const Points card = boxCorners ({0.1, 0.1, 1e-6});
  const ConvexHull far = convexHullOf (movedPoints (card, Eigen::Affine3d (Eigen::Translation3d (0.0, 0.0, 1000.01))));
  EXPECT_FALSE (far.empty ());
  EXPECT_FALSE (isSolid (far.mesh ()));
  EXPECT_TRUE (isSolid (convexHullOf (card).mesh ()));
}

} // namespace
} // namespace pcl::cosection::test
