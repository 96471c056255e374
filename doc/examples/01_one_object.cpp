// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// One object from the upper half of its surface, in place of pcl::Poisson. Writes ball.ply.
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/point_types.h>

#include <cmath>
#include <iostream>

int
main ()
{
  auto points = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>> (); // a ball of 10 cm, seen from above
  for (float x = -0.048f; x <= 0.048f; x += 0.002f)
    for (float y = -0.048f; y <= 0.048f; y += 0.002f)
      if (const float zz = 0.05f * 0.05f - x * x - y * y; zz > 0.0f)
      {
        pcl::PointNormal p;
        p.getVector3fMap () = Eigen::Vector3f (x, y, std::sqrt (zz));
        p.getNormalVector3fMap () = p.getVector3fMap () / 0.05f; // outward
        points->push_back (p);
      }
  pcl::ModelCoefficients table;
  table.values = {0.0f, 0.0f, 1.0f, 0.05f}; // z = -0.05 m

  pcl::cosection::HessianIMLS<pcl::PointNormal> imls;
  imls.setInputCloud (points);
  imls.addSupportPlane (table);
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  if (mesh.polygons.empty ())
    return 1; // the console says why
  pcl::cosection::saveMesh (imls.getTriangleMesh (), "ball.ply");
  std::cout << mesh.polygons.size () << " triangles\n";
}
