// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/small_meshes.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;

namespace {

TriangleMesh
annotatedBox ()
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  for (int v = 0; v < 8; ++v)
  {
    mesh.normals.emplace_back (static_cast<float> (v), 0, 0);
    mesh.colours.push_back ({static_cast<std::uint8_t> (v), 0, 0});
    mesh.confidence.push_back (static_cast<float> (v));
    mesh.sigma_m.push_back (static_cast<float> (2 * v));
    mesh.provenance.push_back (static_cast<std::uint8_t> (v % 4));
  }
  return mesh;
}

} // namespace

TEST (ExtractTriangles, KeepsVerticesInOrderWithTheirProperties)
{
  std::vector<bool> keep (12, false);
  keep[2] = keep[3] = true; // the top: 4 5 6, 5 7 6
  const auto top = extractTriangles (annotatedBox (), keep);
  EXPECT_EQ (top.confidence, (std::vector<float>{4, 5, 6, 7}));
  EXPECT_EQ (top.sigma_m, (std::vector<float>{8, 10, 12, 14}));
  EXPECT_EQ (top.provenance, (std::vector<std::uint8_t>{0, 1, 2, 3}));
  EXPECT_EQ (top.normals[3].x (), 7.0f);
  EXPECT_EQ (top.colours[1][0], 5);
  EXPECT_EQ (top.vertices[0], Eigen::Vector3f (0, 0, 1));
  EXPECT_EQ (top.triangles, (std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST (ExtractTriangles, OfAllOrNone)
{
  const auto mesh = annotatedBox ();
  EXPECT_EQ (extractTriangles (mesh, std::vector<bool> (12, true)).triangles, mesh.triangles);
  EXPECT_TRUE (extractTriangles (mesh, std::vector<bool> (12, false)).vertices.empty ());
  EXPECT_THROW (extractTriangles (mesh, std::vector<bool> (11, true)), InvalidArgument);
}

TEST (AppendMesh, ShiftsIndicesAndKeepsCommonProperties)
{
  auto mesh = annotatedBox ();
  auto other = annotatedBox ();
  other.colours.clear ();
  appendMesh (mesh, other);
  EXPECT_EQ (mesh.vertices.size (), 16u);
  EXPECT_EQ (mesh.triangles[12], (TriangleMesh::Triangle{8, 10, 9}));
  EXPECT_EQ (mesh.normals.size (), 16u);
  EXPECT_TRUE (mesh.colours.empty ());
  EXPECT_EQ (mesh.confidence[9], 1.0f);
  EXPECT_EQ (mesh.sigma_m[9], 2.0f);
  appendMesh (mesh, test::boxMesh ({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE (mesh.normals.empty ());
  EXPECT_TRUE (mesh.provenance.empty ());
}

TEST (AppendMesh, ToOrOfNothingKeepsEverything)
{
  TriangleMesh mesh;
  appendMesh (mesh, annotatedBox ());
  appendMesh (mesh, TriangleMesh ());
  EXPECT_EQ (mesh.colours.size (), 8u);
  EXPECT_EQ (mesh.provenance.size (), 8u);
  appendMesh (mesh, mesh);
  EXPECT_EQ (mesh.triangles.size (), 24u);
  EXPECT_EQ (computeTopology (mesh).components, 2);
}
