// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/point_types.h>

#include <cmath>
#include <iostream>

/** \brief The upper half of a sphere about the origin. */
pcl::PointCloud<pcl::PointNormal>::Ptr
halfSphere (float radius_m)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>> ();
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 80; ++j)
    {
      const float elevation = static_cast<float> (M_PI) / 2.0f * (i + 0.5f) / 40.0f;
      const float azimuth = 2.0f * static_cast<float> (M_PI) * j / 80.0f;
      pcl::PointNormal p;
      p.getNormalVector3fMap () = Eigen::Vector3f (std::cos (elevation) * std::cos (azimuth),
                                                   std::cos (elevation) * std::sin (azimuth), std::sin (elevation));
      p.getVector3fMap () = radius_m * p.getNormalVector3fMap ();
      cloud->push_back (p);
    }
  return cloud;
}

int
main ()
{
  pcl::cosection::HessianIMLS<pcl::PointNormal> imls;
  imls.setInputCloud (halfSphere (0.1f));
  imls.setVoxelSize (0.01f);
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  const bool closed = pcl::cosection::computeTopology (imls.getTriangleMesh ()).closed_manifold;
  std::cout << "half a sphere: " << mesh.polygons.size ()
            << (closed ? " triangles, closed\n" : " triangles, not closed\n");
  return !mesh.polygons.empty () && closed ? 0 : 1;
}
