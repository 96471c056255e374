// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Meshes that are proposed as the shape of an object, of wrong size and in wrong poses.

#include "completion/lowest_vertex.h"
#include "completion_scene.h"
#include "surrounding_views.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A foot, a neck off its middle and a head: no symmetry shows its back. */
Distance
figure ()
{
  const Distance foot = placed (box ({0.05, 0.035, 0.015}), Eigen::Vector3d (0.0, 0.0, 0.015));
  const Distance neck = placed (box ({0.012, 0.02, 0.03}), Eigen::Vector3d (0.02, 0.0, 0.055));
  const Distance head = placed (sphere (0.03), Eigen::Vector3d (0.01, 0.01, 0.1));
  return [=] (const Eigen::Vector3d& p) { return std::min ({foot (p), neck (p), head (p)}); };
}

TriangleMesh
meshOf (const Distance& shape)
{
  return extractIsoSurface (sampleField (shape, 0.15, 0.004));
}

TriangleMesh
transformed (TriangleMesh mesh, double scale, const Eigen::Isometry3d& T)
{
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (scale * (T * vertex.cast<double> ())).cast<float> ();
  return mesh;
}

/** \brief What one view shows of a shape on the table, completed with proposals. */
ObjectResult
completeWith (const Distance& shape, const std::vector<TriangleMesh>& proposals)
{
  const RenderedView seen = seenFromTheFront (shape);
  CoSection task (optionsFor (0.004));
  task.addView (seen.view);
  task.setBackground (seen.points.at (0));
  task.addObject ({1, seen.points.at (1), {}, proposals});
  return task.reconstruct ().objects.at (0);
}

} // namespace

class Proposals : public testing::TestWithParam<int>
{
protected:
  /** \brief A pose and a size as a generator may give them. */
  TriangleMesh generated () const
  {
    const double n = GetParam ();
    const Eigen::Vector3d axis (std::sin (n), std::cos (2.0 * n), std::sin (3.0 * n + 1.0));
    return transformed (meshOf (figure ()), std::exp2 (std::sin (1.0 + 2.0 * n)),
                        motion (1.0 + n, axis.normalized (), {0.3 * n, -1.0, 0.2}));
  }
};

TEST_P (Proposals, TheTrueShapeOfWrongSizeAndPoseIsAligned)
{
  const ObjectResult result = completeWith (figure (), {generated ()});
  ASSERT_EQ (result.error, "");
  ASSERT_TRUE (result.proposal);
  EXPECT_TRUE (result.proposal->used);
  EXPECT_NEAR (result.proposal->scale * std::exp2 (std::sin (1.0 + 2.0 * GetParam ())), 1.0, 0.02);
  double sum_m = 0.0;
  const TriangleMesh mesh = generated ();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    sum_m += std::abs (figure () (result.proposal->T_object_proposal * vertex.cast<double> ()));
  EXPECT_LT (sum_m / static_cast<double> (mesh.vertices.size ()), 0.002);
  EXPECT_LT (meanError (result.mesh, figure ()), 0.0015);
  EXPECT_LT (meanError (result.mesh, figure ()), 0.7 * meanError (completeWith (figure (), {}).mesh, figure ()));
}

INSTANTIATE_TEST_SUITE_P (Poses, Proposals, testing::Values (1, 2, 3, 4));

TEST (Proposals, WhatDoesNotExplainTheMeasurementsChangesNothing)
{
  const TriangleMesh wrong = meshOf (placed (box ({0.1, 0.01, 0.01}), Eigen::Vector3d (0.0, 0.0, 0.02)));
  const ObjectResult with = completeWith (figure (), {wrong}), without = completeWith (figure (), {});
  ASSERT_TRUE (with.proposal);
  EXPECT_FALSE (with.proposal->used);
  EXPECT_EQ (with.mesh.vertices, without.mesh.vertices);
  EXPECT_EQ (with.mesh.triangles, without.mesh.triangles);
}

TEST (Proposals, WrongProportionsChangeNothing)
{
  const Distance taller = [] (const Eigen::Vector3d& p) { return figure () ({p.x (), p.y (), p.z () / 1.3}); };
  const ObjectResult with = completeWith (figure (), {meshOf (taller)}), without = completeWith (figure (), {});
  ASSERT_TRUE (with.proposal);
  EXPECT_FALSE (with.proposal->used);
  EXPECT_TRUE (with.proposal->withdrawn) << "it is aligned well at first";
  EXPECT_EQ (with.mesh.vertices, without.mesh.vertices);
  EXPECT_EQ (with.mesh.triangles, without.mesh.triangles);
}

TEST (Proposals, TheBestOfSeveralIsTaken)
{
  const TriangleMesh wrong = meshOf (placed (box ({0.1, 0.01, 0.01}), Eigen::Vector3d (0.0, 0.0, 0.02)));
  const ObjectResult result = completeWith (figure (), {wrong, meshOf (figure ()), wrong});
  ASSERT_TRUE (result.proposal);
  EXPECT_EQ (result.proposal->proposal, 1u);
  EXPECT_TRUE (result.proposal->used);
}

TEST (Proposals, MeshesThatAreNoneAreRefused)
{
  CoSection scene;
  EXPECT_THROW (scene.addObject ({1, {}, {}, {TriangleMesh ()}}), DegenerateInput);
  TriangleMesh mesh = meshOf (sphere (0.05));
  mesh.triangles.front ()[0] = static_cast<std::uint32_t> (mesh.vertices.size ());
  EXPECT_THROW (scene.addObject ({1, {}, {}, {mesh}}), InvalidArgument);
  mesh = meshOf (sphere (0.05));
  mesh.vertices.front ().x () = std::nanf ("");
  EXPECT_THROW (scene.addObject ({1, {}, {}, {mesh}}), InvalidArgument);
  EXPECT_NO_THROW (scene.addObject ({1, {}, {}, {meshOf (sphere (0.05))}}));
}

TEST (Proposals, WhatIsSunkIntoTheTableComesOutOfIt)
{
  const Distance foot = placed (box ({0.05, 0.035, 0.025}), Eigen::Vector3d (0.0, 0.0, 0.005)); // 2 cm below
  const Distance sunk = [=] (const Eigen::Vector3d& p) { return std::min (figure () (p), foot (p)); };
  const ObjectResult with = completeWith (figure (), {meshOf (sunk)});
  ASSERT_TRUE (with.proposal);
  EXPECT_GT (lowest (with.mesh), -0.002f);
  EXPECT_LE (with.penetration_m, 0.004);
  EXPECT_LT (meanError (with.mesh, figure ()), meanError (completeWith (figure (), {}).mesh, figure ()) + 0.0005);
}

TEST (Proposals, WhatReachesIntoANeighbourKeepsClearOfIt)
{
  const Distance wall = placed (box ({0.05, 0.02, 0.08}), Eigen::Vector3d (0.0, 0.06, 0.08));
  const Distance arm = placed (box ({0.015, 0.02, 0.01}), Eigen::Vector3d (0.0, 0.045, 0.02)); // 2.5 cm into the wall
  const Distance reaching = [=] (const Eigen::Vector3d& p) { return std::min (figure () (p), arm (p)); };
  AnalyticScene scene;
  scene.add (0, tableScene (Shape::Sphere).shape (0));
  scene.add (1, figure ());
  scene.add (2, wall);
  const RenderedView seen = scene.render (tableCamera (), fromTheFront ());
  CoSection task (optionsFor (0.004));
  task.addView (seen.view);
  task.setBackground (seen.points.at (0));
  task.addObject ({1, seen.points.at (1), {}, {meshOf (reaching)}});
  task.addObject ({2, seen.points.at (2), {}});
  const std::vector<ObjectResult> results = task.reconstruct ().objects;
  ASSERT_TRUE (results.at (0).proposal);
  EXPECT_TRUE (results[0].proposal->used);
  for (const ObjectResult& result : results)
    EXPECT_LE (result.penetration_m, 0.004) << result.id;
  EXPECT_LT (meanError (results[0].mesh, figure ()), 0.0025);
}

TEST (CoSectionInput, NormalsAreOfAnyLength)
{
  const RenderedView seen = seenFromTheFront (figure ());
  const auto completed = [&] (float factor) {
    CoSection task (optionsFor (0.004));
    task.addView (seen.view);
    std::vector<OrientedPoint> background = seen.points.at (0), points = seen.points.at (1);
    for (std::vector<OrientedPoint>* all : {&background, &points})
      for (OrientedPoint& point : *all)
        point.normal *= factor;
    task.setBackground (background);
    task.addObject ({1, points, {}});
    return task.reconstruct ().objects.at (0).mesh;
  };
  const double error_m = meanError (completed (1.0f), figure ());
  for (const float factor : {0.001f, 7.0f})
    EXPECT_NEAR (meanError (completed (factor), figure ()), error_m, 1e-5) << factor;
}

TEST (CoSectionInput, PosesAreRigid)
{
  const RenderedView seen = seenFromTheFront (figure ());
  Eigen::Isometry3d scaled = Eigen::Isometry3d::Identity ();
  scaled.linear () *= 2.0;
  CoSection task (optionsFor (0.004));
  EXPECT_THROW (task.addView (seen.view, {{1, scaled}}), InvalidArgument);
  EXPECT_THROW (task.addObstacle (meshOf (figure ()), {scaled}), InvalidArgument);
}
