// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "rivals.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <pcl/point_types.h>
#include <pcl/surface/convex_hull.h>
#include <pcl/surface/marching_cubes_hoppe.h>
#include <pcl/surface/poisson.h>

#include <utility>

namespace pcl::cosection::test {
namespace {

constexpr int poisson_depth = 6;
constexpr int hoppe_cells = 50;
constexpr float hoppe_margin = 0.1f;

pcl::PointCloud<pcl::PointNormal>::Ptr
toCloud (const std::vector<OrientedPoint>& points)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>> ();
  for (const OrientedPoint& p : points)
    cloud->emplace_back (p.position.x (), p.position.y (), p.position.z (), p.normal.x (), p.normal.y (),
                         p.normal.z ());
  return cloud;
}

} // namespace

TriangleMesh
poissonSurface (const std::vector<OrientedPoint>& points)
{
  pcl::Poisson<pcl::PointNormal> method;
  method.setDepth (poisson_depth);
  method.setInputCloud (toCloud (points));
  pcl::PolygonMesh mesh;
  method.reconstruct (mesh);
  return fromPolygonMesh (mesh);
}

TriangleMesh
convexHull (const std::vector<OrientedPoint>& points)
{
  pcl::ConvexHull<pcl::PointNormal> method;
  method.setDimension (3);
  method.setInputCloud (toCloud (points));
  pcl::PolygonMesh polygons;
  method.reconstruct (polygons);
  TriangleMesh mesh = fromPolygonMesh (polygons);
  Eigen::Vector3f middle = Eigen::Vector3f::Zero ();
  for (const Eigen::Vector3f& v : mesh.vertices)
    middle += v / static_cast<float> (mesh.vertices.size ());
  for (auto& [a, b, c] : mesh.triangles) // qhull does not turn them
  {
    const Eigen::Vector3f n = (mesh.vertices[b] - mesh.vertices[a]).cross (mesh.vertices[c] - mesh.vertices[a]);
    if (n.dot (mesh.vertices[a] - middle) < 0.0f)
      std::swap (b, c);
  }
  return mesh;
}

TriangleMesh
hoppeSurface (const std::vector<OrientedPoint>& points)
{
  pcl::MarchingCubesHoppe<pcl::PointNormal> method;
  method.setGridResolution (hoppe_cells, hoppe_cells, hoppe_cells);
  method.setPercentageExtendGrid (hoppe_margin);
  method.setIsoLevel (0.0f);
  method.setInputCloud (toCloud (points));
  pcl::PolygonMesh mesh;
  method.reconstruct (mesh);
  return fromPolygonMesh (mesh);
}

} // namespace pcl::cosection::test
