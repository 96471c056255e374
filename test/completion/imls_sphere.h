// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// Shared by the tests of HessianIMLS: points of a sphere, and expectations on its mesh.

namespace pcl::cosection::test {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Imls = HessianIMLS<pcl::PointNormal>;

constexpr float radius = 0.1f;
constexpr float voxel = 0.01f;

/** \brief Points spread evenly over the part of a sphere about the origin that a sensor far up the z axis
 * sees, or over all of it. */
template <typename PointT = pcl::PointNormal>
typename pcl::PointCloud<PointT>::Ptr
sphereCloud (bool one_sided, int count = 4000)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>> ();
  const double golden = M_PI * (3.0 - std::sqrt (5.0));
  for (int i = 0; i < count; ++i)
  {
    const double z = one_sided ? 1.0 - (i + 0.5) / count : 1.0 - 2.0 * (i + 0.5) / count;
    const double s = std::sqrt (1.0 - z * z);
    const Eigen::Vector3f d = Eigen::Vector3d (s * std::cos (golden * i), s * std::sin (golden * i), z).cast<float> ();
    PointT p;
    p.getVector3fMap () = radius * d;
    p.getNormalVector3fMap () = d;
    cloud->push_back (p);
  }
  return cloud;
}

inline bool
closed (const TriangleMesh& mesh)
{
  return !mesh.empty () && computeTopology (mesh).closed_manifold;
}

inline TriangleMesh
toTriangleMesh (const pcl::PolygonMesh& mesh)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::fromPCLPointCloud2 (mesh.cloud, cloud);
  TriangleMesh out;
  for (const auto& p : cloud)
    out.vertices.push_back (p.getVector3fMap ());
  for (const auto& polygon : mesh.polygons)
  {
    EXPECT_EQ (3u, polygon.vertices.size ());
    TriangleMesh::Triangle triangle;
    std::copy_n (polygon.vertices.begin (), 3, triangle.begin ());
    out.triangles.push_back (triangle);
  }
  return out;
}

inline pcl::PolygonMesh
reconstruct (Imls& imls)
{
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  return mesh;
}

/** \brief Expect empty outputs, as after a failure. */
inline void
expectNothing (Imls& imls)
{
  pcl::PolygonMesh mesh;
  mesh.polygons.resize (3); // remains of an earlier use
  mesh.cloud.width = 7;
  imls.reconstruct (mesh);
  EXPECT_TRUE (mesh.polygons.empty ());
  EXPECT_EQ (0u, mesh.cloud.width * mesh.cloud.height);
  Cloud points (5, 1);
  std::vector<pcl::Vertices> polygons (5);
  imls.reconstruct (points, polygons);
  EXPECT_TRUE (points.empty ());
  EXPECT_TRUE (polygons.empty ());
  EXPECT_EQ (nullptr, imls.getSignedDistance ());
  EXPECT_TRUE (imls.getTriangleMesh ().empty ());
}

} // namespace pcl::cosection::test
