// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/small_meshes.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;

TEST (MeshTopology, OfClosedSurfaces)
{
  const auto box = computeTopology (test::boxMesh ({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE (box.closed_manifold);
  EXPECT_EQ (box.euler, 2);
  EXPECT_EQ (box.components, 1);
  const auto torus = computeTopology (test::torusMesh (1.0, 0.3, 12, 7));
  EXPECT_TRUE (torus.closed_manifold);
  EXPECT_EQ (torus.euler, 0);
  const auto sphere = computeTopology (test::sphereMesh (1.0, 6));
  EXPECT_TRUE (sphere.closed_manifold);
  EXPECT_EQ (sphere.euler, 2);
}

TEST (MeshTopology, CountsTheBoundary)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  mesh.triangles.resize (10); // without one side
  const auto topology = computeTopology (mesh);
  EXPECT_FALSE (topology.closed_manifold);
  EXPECT_EQ (topology.boundary_edges, 4);
  EXPECT_EQ (topology.non_manifold_edges, 0);
  EXPECT_EQ (topology.non_manifold_vertices, 0);
  EXPECT_EQ (topology.euler, 1);
}

TEST (MeshTopology, SeesAFlippedTriangle)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  std::swap (mesh.triangles[3][0], mesh.triangles[3][1]);
  const auto topology = computeTopology (mesh);
  EXPECT_FALSE (topology.closed_manifold);
  EXPECT_EQ (topology.non_manifold_edges, 3);
}

TEST (MeshTopology, SeesBoxesThatTouchInAnEdgeOrAVertex)
{
  // The second box lies beyond vertex 7 of the first one.
  auto vertex = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  appendMesh (vertex, test::boxMesh ({1, 1, 1}, {2, 2, 2}));
  for (auto& t : vertex.triangles)
    for (auto& v : t)
      v = (v == 8 ? 7 : v);
  const auto at_vertex = computeTopology (vertex);
  EXPECT_FALSE (at_vertex.closed_manifold);
  EXPECT_EQ (at_vertex.non_manifold_vertices, 1);
  EXPECT_EQ (at_vertex.non_manifold_edges, 0);
  EXPECT_EQ (at_vertex.components, 1);

  auto edge = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  appendMesh (edge, test::boxMesh ({0, 1, 1}, {1, 2, 2}));
  for (auto& t : edge.triangles)
    for (auto& v : t)
      v = (v == 8 ? 6 : v == 9 ? 7 : v);
  const auto at_edge = computeTopology (edge);
  EXPECT_FALSE (at_edge.closed_manifold);
  EXPECT_EQ (at_edge.non_manifold_edges, 1);
}

TEST (MeshTopology, SeesRepeatedCorners)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  mesh.triangles.push_back ({2, 2, 3});
  EXPECT_FALSE (computeTopology (mesh).closed_manifold);
}

TEST (MeshTopology, OfNothing)
{
  EXPECT_FALSE (computeTopology ({}).closed_manifold);
  EXPECT_EQ (computeTopology ({}).components, 0);
}

TEST (MeshTopology, CountsComponentsOfReferencedVertices)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  mesh.vertices.emplace_back (9, 9, 9); // not used
  appendMesh (mesh, test::boxMesh ({4, 0, 0}, {5, 1, 1}));
  const auto topology = computeTopology (mesh);
  EXPECT_TRUE (topology.closed_manifold);
  EXPECT_EQ (topology.components, 2);
  EXPECT_EQ (topology.euler, 4);
  const std::vector<int> expected = {0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2, 2};
  EXPECT_EQ (labelComponents (mesh), expected);
}

TEST (MeshTopology, RefusesIndicesOutOfRange)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  mesh.triangles[0][0] = 8;
  EXPECT_THROW (computeTopology (mesh), InvalidArgument);
  EXPECT_THROW (labelComponents (mesh), InvalidArgument);
  EXPECT_THROW (computeMassProperties (mesh), InvalidArgument);
}
