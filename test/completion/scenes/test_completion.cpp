// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/mesh_distance.h"
#include "completion_fixture.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST_P (Completion, IsAClosedManifold)
{
  const MeshTopology topology = computeTopology (object ().mesh);
  EXPECT_TRUE (topology.closed_manifold);
  EXPECT_EQ (topology.components, 1);
  EXPECT_GT (computeMassProperties (object ().mesh).volume_m3, 0.0);
}

TEST_P (Completion, GoesThroughTheObservedPoints)
{
  const MeshDistance distance (object ().mesh, 2.0 * voxel_m_);
  const auto& points = seen_.points.at (1);
  const auto near = std::count_if (points.begin (), points.end (), [&] (const OrientedPoint& p) {
    return distance (p.position.cast<double> ()) <= voxel_m_;
  });
  EXPECT_GE (static_cast<double> (near), 0.95 * static_cast<double> (points.size ()));
}

TEST_P (Completion, IsRightAtTheSilhouette)
{
  // Points seen beside pixels that do not show the object.
  std::vector<Eigen::Vector3d> silhouette;
  const PinholeCamera& camera = seen_.view.camera;
  const auto shows = [&] (int u, int v) { return seen_.labels[static_cast<std::size_t> (v) * camera.width + u] == 1; };
  for (int v = 1; v + 1 < camera.height; ++v)
    for (int u = 1; u + 1 < camera.width; ++u)
      if (shows (u, v) && !(shows (u - 1, v) && shows (u + 1, v) && shows (u, v - 1) && shows (u, v + 1)))
        silhouette.push_back (T_world_sensor_ * camera.unproject (u, v, seen_.view.at (u, v)));
  EXPECT_LE (largestError (Provenance::Hull,
                           [&] (const Eigen::Vector3d& p) {
                             return std::any_of (
                                 silhouette.begin (), silhouette.end (),
                                 [&] (const Eigen::Vector3d& q) { return (p - q).norm () < 2.0 * voxel_m_; });
                           }),
             2.0);
}

TEST_P (Completion, FindsTheTable)
{
  ASSERT_EQ (result_.planes.size (), 1u);
  EXPECT_LE ((result_.planes[0] - Eigen::Vector4d (0.0, 0.0, 1.0, 0.0)).norm (), 1e-3)
      << result_.planes[0].transpose ();
  ASSERT_FALSE (result_.background.empty ());
  double farthest = 0.0;
  for (const Eigen::Vector3f& v : result_.background.vertices)
    farthest = std::max (farthest, std::abs (static_cast<double> (v.z ())));
  EXPECT_LE (farthest, 2.0 * voxel_m_); // a voxel of the background
}

TEST_P (Completion, AttributesMatchTheMesh)
{
  const TriangleMesh& mesh = object ().mesh;
  ASSERT_EQ (mesh.normals.size (), mesh.vertices.size ());
  ASSERT_EQ (mesh.provenance.size (), mesh.vertices.size ());
  ASSERT_EQ (mesh.confidence.size (), mesh.vertices.size ());
  std::size_t observed = 0;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    ASSERT_GE (mesh.confidence[v], 0.0f);
    ASSERT_LE (mesh.confidence[v], 1.0f);
    if (mesh.provenance[v] != static_cast<std::uint8_t> (Provenance::Observed))
      continue;
    ++observed;
    EXPECT_GE (mesh.confidence[v], std::exp (-1.0 / 5.0) - 1e-4);
  }
  EXPECT_GT (observed, mesh.vertices.size () / 5);
}

TEST_P (Completion, SaysHowSureItIs)
{
  const TriangleMesh& mesh = object ().mesh;
  ASSERT_EQ (mesh.sigma_m.size (), mesh.vertices.size ());
  double within = 0.0, observed_m = 0.0, hidden_m = 0.0;
  std::size_t observed = 0;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    EXPECT_GT (mesh.sigma_m[v], 0.0f);
    within += std::abs (scene_.shape (1) (mesh.vertices[v].cast<double> ())) <= 2.0 * mesh.sigma_m[v];
    const bool is_observed = mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed);
    observed += is_observed;
    (is_observed ? observed_m : hidden_m) += mesh.sigma_m[v];
  }
  // 0.95 on average over many things; the errors of a single one depend on each other.
  EXPECT_GE (within, 0.8 * static_cast<double> (mesh.vertices.size ()));
  EXPECT_LT (1.5 * observed_m / static_cast<double> (observed),
             hidden_m / static_cast<double> (mesh.vertices.size () - observed));
  EXPECT_EQ (result_.background.sigma_m.size (), result_.background.vertices.size ());
}

INSTANTIATE_TEST_SUITE_P (Table, Completion, completionCases (), completionCaseName);

/** \brief The visible hole of a ring and the hollow of a cup stay open. */
TEST (CompletionTopology, KeepsWhatIsSeenHollow)
{
  for (const auto& [shape, euler] : {std::make_pair (Shape::Sphere, 2), std::make_pair (Shape::Torus, 0)})
  {
    const RenderedView seen = tableScene (shape).render (tableCamera (), fromAbove ());
    const SceneResult result = complete (seen, optionsFor (0.005));
    EXPECT_EQ (computeTopology (result.objects.at (0).mesh).euler, euler) << nameOf (shape);
  }
  const RenderedView seen = tableScene (Shape::Cup).render (tableCamera (), fromAbove ());
  const SceneResult result = complete (seen, optionsFor (0.005));
  const auto inside = result.objects.at (0).signed_distance->sample ({0.0, 0.0, 0.085});
  ASSERT_TRUE (inside);
  EXPECT_GT (*inside, 0.005f);
}

/** \brief A reading that is wrong is no handle, beside which the wall would be left out. */
TEST (CompletionTopology, OnePointOffTheWallOfACupLeavesNoHole)
{
  AnalyticScene scene;
  scene.add (0, halfSpace (table_plane));
  scene.add (1, cup (0.045, 0.09, 0.005));
  RenderedView seen = scene.render (tableCamera (), fromAbove ());
  const CoSectionOptions options = optionsFor (0.003);
  const TriangleMesh without = complete (seen, options).objects.at (0).mesh;
  const MeshDistance distance (without, 0.02);
  for (const float angle : {0.0f, 1.6f, 3.1f, 4.7f})
  {
    const Eigen::Vector3f out (std::cos (angle), std::sin (angle), 0.0f);
    std::vector<OrientedPoint>& points = seen.points.at (1);
    points.push_back ({0.034f * out + Eigen::Vector3f (0.0f, 0.0f, 0.015f), -out, points.front ().weight, {}});
    const TriangleMesh mesh = complete (seen, options).objects.at (0).mesh;
    points.pop_back ();
    double largest_m = 0.0;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      largest_m = std::max (largest_m, distance (vertex.cast<double> ()));
    EXPECT_LT (largest_m, 0.0005) << angle; // a sixth of a voxel
  }
}

TEST (CompletionErrors, LoseOnlyTheObjectConcerned)
{
  RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  seen.points[2] = {OrientedPoint{Eigen::Vector3f::Zero (), Eigen::Vector3f::UnitZ (), 1.0f, {}}};
  const SceneResult result = complete (seen, optionsFor (0.006));
  ASSERT_EQ (result.objects.size (), 2u);
  EXPECT_EQ (result.objects[0].error, "");
  EXPECT_TRUE (computeTopology (result.objects[0].mesh).closed_manifold);
  EXPECT_NE (result.objects[1].error, "");
  EXPECT_TRUE (result.objects[1].mesh.empty ());
}

TEST (CompletionErrors, WeightsAreLikelihoods)
{
  for (const float weight : {-1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN ()})
  {
    const std::vector<OrientedPoint> points = {{Eigen::Vector3f::Zero (), Eigen::Vector3f::UnitZ (), weight, {}}};
    CoSection scene;
    EXPECT_THROW (scene.addObject ({1, points, {}}), InvalidArgument) << weight;
    EXPECT_THROW (scene.addPoints (1, points), InvalidArgument) << weight;
    EXPECT_THROW (scene.setBackground (points), InvalidArgument) << weight;
    EXPECT_THROW (scene.addBackground (points), InvalidArgument) << weight;
    EXPECT_TRUE (scene.reconstruct ().objects.empty ());
  }
}

TEST (CompletionErrors, AMovedFromSceneIsEmpty)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  CoSection first (optionsFor (0.01));
  first.addObject ({1, seen.points.at (1), {}});
  CoSection second (std::move (first));
  EXPECT_TRUE (first.reconstruct ().objects.empty ()); // NOLINT(bugprone-use-after-move): that is the question
  first = std::move (second);
  EXPECT_EQ (first.reconstruct ().objects.size (), 1u);
  EXPECT_TRUE (second.reconstruct ().objects.empty ()); // NOLINT(bugprone-use-after-move)
}

TEST (CompletionErrors, CancelFromTheCallback)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  CoSection scene (optionsFor (0.006));
  scene.addView (seen.view);
  scene.setBackground (seen.points.at (0));
  scene.addObject ({1, seen.points.at (1), {}});
  double last = 0.0;
  int calls = 0;
  scene.reconstruct ([&] (const std::string&, double fraction) {
    EXPECT_GE (fraction, last);
    EXPECT_LE (fraction, 1.0);
    last = fraction;
    ++calls;
    return true;
  });
  EXPECT_EQ (last, 1.0);
  for (const int allowed : {0, calls / 2, calls - 1})
  {
    int n = 0;
    EXPECT_THROW (scene.reconstruct ([&] (const std::string&, double) { return n++ < allowed; }), Cancelled) << allowed;
  }
}
