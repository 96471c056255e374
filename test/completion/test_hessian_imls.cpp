// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "imls_sphere.h"

#include <pcl/common/io.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/search/kdtree.h>

#include <thread>

// HessianIMLS as a drop-in for pcl::Poisson.

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (HessianImls, ClosesASphereSeenFromOneSide)
{
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setVoxelSize (voxel);
  const pcl::PolygonMesh mesh = reconstruct (imls);
  EXPECT_TRUE (closed (toTriangleMesh (mesh)));
  EXPECT_TRUE (imls.getSolverSummary ().converged ());
  double farthest = 0.0;
  for (const Eigen::Vector3f& v : toTriangleMesh (mesh).vertices)
    if (v.z () > 0.3f * radius) // where it was seen
      farthest = std::max (farthest, std::abs (v.norm () - static_cast<double> (radius)));
  EXPECT_LT (farthest, 0.5 * voxel);
}

TEST (HessianImls, WorksThroughTheBaseClass)
{
  const pcl::SurfaceReconstruction<pcl::PointNormal>::Ptr method = pcl::make_shared<Imls> ();
  method->setInputCloud (sphereCloud (true));
  pcl::PolygonMesh mesh;
  method->reconstruct (mesh);
  EXPECT_TRUE (closed (toTriangleMesh (mesh)));
  Cloud points;
  std::vector<pcl::Vertices> polygons;
  method->reconstruct (points, polygons);
  EXPECT_EQ (mesh.polygons.size (), polygons.size ());
}

TEST (HessianImls, BothOverloadsAgree)
{
  Imls imls;
  auto cloud = sphereCloud (true);
  cloud->header.frame_id = "object";
  imls.setInputCloud (cloud);
  imls.setVoxelSize (voxel);
  const pcl::PolygonMesh mesh = reconstruct (imls);
  Cloud points;
  std::vector<pcl::Vertices> polygons;
  imls.reconstruct (points, polygons);

  Cloud of_mesh;
  pcl::fromPCLPointCloud2 (mesh.cloud, of_mesh);
  ASSERT_EQ (of_mesh.size (), points.size ());
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    ASSERT_EQ (of_mesh[i].getVector3fMap (), points[i].getVector3fMap ());
    ASSERT_EQ (of_mesh[i].getNormalVector3fMap (), points[i].getNormalVector3fMap ());
  }
  ASSERT_EQ (mesh.polygons.size (), polygons.size ());
  for (std::size_t i = 0; i < polygons.size (); ++i)
    ASSERT_EQ (mesh.polygons[i].vertices, polygons[i].vertices);
  EXPECT_EQ ("object", mesh.header.frame_id);
  EXPECT_EQ ("object", mesh.cloud.header.frame_id);
  EXPECT_EQ ("object", points.header.frame_id);
}

TEST (HessianImls, HonoursIndices)
{
  const auto wanted = sphereCloud (true);
  auto both = pcl::make_shared<Cloud> (*wanted);
  for (pcl::PointNormal p : *wanted)
  {
    p.x += 0.5f;
    both->push_back (p);
  }
  auto indices = pcl::make_shared<pcl::Indices> ();
  for (std::size_t i = 0; i < wanted->size (); ++i)
    indices->push_back (static_cast<pcl::index_t> (i));
  Imls of_part, alone;
  of_part.setInputCloud (both);
  of_part.setIndices (indices);
  alone.setInputCloud (wanted);
  const pcl::PolygonMesh mesh = reconstruct (of_part);
  EXPECT_FALSE (mesh.polygons.empty ());
  EXPECT_EQ (reconstruct (alone).cloud.data, mesh.cloud.data);
}

TEST (HessianImls, KeepsColours)
{
  auto cloud = sphereCloud<pcl::PointXYZRGBNormal> (true);
  for (auto& p : *cloud)
  {
    p.r = p.x < 0.0f ? 200 : 20;
    p.g = 90;
    p.b = 30;
  }
  HessianIMLS<pcl::PointXYZRGBNormal> imls;
  imls.setInputCloud (cloud);
  imls.setVoxelSize (voxel);
  pcl::PointCloud<pcl::PointXYZRGBNormal> points, of_mesh;
  std::vector<pcl::Vertices> polygons;
  imls.reconstruct (points, polygons);
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  pcl::fromPCLPointCloud2 (mesh.cloud, of_mesh);
  ASSERT_FALSE (points.empty ());
  ASSERT_EQ (points.size (), of_mesh.size ());
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    ASSERT_EQ (points[i].rgba & 0xffffffu, of_mesh[i].rgba & 0xffffffu);
    if (points[i].z > 0.3f * radius && std::abs (points[i].x) > 4.0f * voxel) // seen, and away from the seam
    {
      EXPECT_NEAR (points[i].x < 0.0f ? 200 : 20, points[i].r, 1);
      EXPECT_NEAR (90, points[i].g, 1);
      EXPECT_NEAR (30, points[i].b, 1);
    }
  }
}

TEST (HessianImls, FollowsFilterAndNormalEstimation)
{
  auto dense = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> ();
  pcl::copyPointCloud (*sphereCloud (true, 20000), *dense);
  auto thinned = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> ();
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud (dense);
  filter.setLeafSize (0.005f, 0.005f, 0.005f);
  filter.filter (*thinned);
  ASSERT_LT (thinned->size (), dense->size ());
  auto oriented = pcl::make_shared<Cloud> ();
  pcl::copyPointCloud (*thinned, *oriented);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> normals;
  normals.setInputCloud (thinned);
  normals.setSearchMethod (pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>> ());
  normals.setKSearch (20);
  normals.setViewPoint (0.0f, 0.0f, 1.0f);
  normals.compute (*oriented);
  Imls imls;
  imls.setInputCloud (oriented);
  EXPECT_TRUE (closed (toTriangleMesh (reconstruct (imls))));
}

TEST (HessianImls, TwoObjectsInTwoThreadsMakeTheSameBytesAsOneAfterTheOther)
{
  const auto run = [] (bool one_sided, pcl::PolygonMesh& mesh) {
    Imls imls;
    imls.setInputCloud (sphereCloud (one_sided));
    imls.setVoxelSize (voxel);
    imls.reconstruct (mesh);
  };
  pcl::PolygonMesh before[2], at_once[2];
  run (true, before[0]);
  run (false, before[1]);
  std::thread other (run, true, std::ref (at_once[0]));
  run (false, at_once[1]);
  other.join ();
  for (int i = 0; i < 2; ++i)
  {
    ASSERT_FALSE (before[i].polygons.empty ());
    EXPECT_EQ (before[i].cloud.data, at_once[i].cloud.data);
    ASSERT_EQ (before[i].polygons.size (), at_once[i].polygons.size ());
    for (std::size_t t = 0; t < before[i].polygons.size (); ++t)
      ASSERT_EQ (before[i].polygons[t].vertices, at_once[i].polygons[t].vertices);
  }
}

TEST (HessianImls, IsReusable)
{
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setVoxelSize (voxel);
  const pcl::PolygonMesh first = reconstruct (imls);
  imls.setInputCloud (pcl::make_shared<Cloud> ());
  expectNothing (imls);
  imls.setInputCloud (sphereCloud (true));
  EXPECT_EQ (first.cloud.data, reconstruct (imls).cloud.data);
}
