// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "imls_sphere.h"

#include <vector>

// HessianIMLS on input that determines no surface gives a message and empty outputs, and does not crash.

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (HessianImlsDegenerate, NoInputCloud)
{
  Imls imls;
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, EmptyCloud)
{
  Imls imls;
  imls.setInputCloud (pcl::make_shared<Cloud> ());
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, NoIndices)
{
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setIndices (pcl::make_shared<pcl::Indices> ());
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, NotANumber)
{
  auto cloud = sphereCloud (true);
  for (auto& p : *cloud)
    p.y = not_a_number;
  Imls imls;
  imls.setInputCloud (cloud);
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, NoNormals)
{
  auto cloud = sphereCloud (true);
  for (std::size_t i = 0; i < cloud->size (); ++i)
    (*cloud)[i].getNormalVector3fMap ().setConstant (i % 2 ? not_a_number : 0.0f);
  Imls imls;
  imls.setInputCloud (cloud);
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, OnePoint)
{
  Imls imls;
  imls.setInputCloud (sphereCloud (true, 1));
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, VoxelLargerThanTheObject)
{
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setVoxelSize (10.0f);
  expectNothing (imls);
}

TEST (HessianImlsDegenerate, CoplanarPointsCloseOrSayWhy)
{
  auto cloud = pcl::make_shared<Cloud> ();
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j)
    {
      pcl::PointNormal p;
      p.getVector3fMap () = Eigen::Vector3f (0.004f * i, 0.004f * j, 0.0f);
      p.getNormalVector3fMap () = Eigen::Vector3f::UnitZ ();
      cloud->push_back (p);
    }
  Imls imls;
  imls.setInputCloud (cloud);
  const TriangleMesh mesh = toTriangleMesh (reconstruct (imls));
  EXPECT_TRUE (mesh.empty () || closed (mesh));
}

TEST (HessianImlsDegenerate, SomePointsAreNotFinite)
{
  const auto good = sphereCloud (true);
  auto cloud = pcl::make_shared<Cloud> (*good);
  for (int i = 0; i < 100; ++i)
  {
    pcl::PointNormal p = (*good)[i];
    (i % 2 ? p.x : p.normal_z) = not_a_number;
    cloud->push_back (p);
  }
  Imls with, without;
  with.setInputCloud (cloud);
  without.setInputCloud (good);
  const pcl::PolygonMesh mesh = reconstruct (with);
  EXPECT_FALSE (mesh.polygons.empty ());
  EXPECT_EQ (reconstruct (without).cloud.data, mesh.cloud.data);
}
