// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The code of doc/tutorial_hessian_imls.md, on a ball on a table of which one view was taken.

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <cmath>
#include <iostream>

namespace {

constexpr float radius = 0.05f;
constexpr float ball_z = 0.6f;   // in front of the sensor
constexpr float table_y = 0.05f; // below it: y points down

/** \brief What a depth camera at the origin sees. */
pcl::PointCloud<pcl::PointXYZ>
depthImage ()
{
  pcl::PointCloud<pcl::PointXYZ> cloud (160, 120);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 160; ++u)
    {
      const Eigen::Vector3f ray ((u - 79.5f) / 260.0f, (v - 59.5f) / 260.0f, 1.0f);
      const float a = ray.squaredNorm ();
      const float discriminant = ball_z * ball_z - a * (ball_z * ball_z - radius * radius);
      float z = ray.y () > 0.0f ? table_y / ray.y () : std::nanf ("");
      if (discriminant > 0.0f)
        z = (ball_z - std::sqrt (discriminant)) / a;
      cloud (u, v).getVector3fMap () = z * ray;
    }
  return cloud;
}

/** \brief The points on the ball, with normals. */
pcl::PointCloud<pcl::PointNormal>::Ptr
ball (const pcl::PointCloud<pcl::PointXYZ>& cloud)
{
  const Eigen::Vector3f centre (0.0f, 0.0f, ball_z);
  auto points = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>> ();
  for (const auto& p : cloud)
    if ((p.getVector3fMap () - centre).norm () < 1.01f * radius)
    {
      pcl::PointNormal point;
      point.getVector3fMap () = p.getVector3fMap ();
      point.getNormalVector3fMap () = (p.getVector3fMap () - centre).normalized ();
      points->push_back (point);
    }
  return points;
}

void
poisson (const pcl::PointCloud<pcl::PointNormal>::ConstPtr& points, pcl::PolygonMesh& mesh)
{
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth (6);
  poisson.setInputCloud (points);
  poisson.reconstruct (mesh);
}

pcl::cosection::SignedDistanceField::ConstPtr
hessianImls (const pcl::PointCloud<pcl::PointNormal>::ConstPtr& points,
             const pcl::PointCloud<pcl::PointXYZ>& depth_image, pcl::PolygonMesh& mesh)
{
  pcl::ModelCoefficients table;
  table.values = {0.0f, 1.0f, 0.0f, -table_y};

  pcl::cosection::HessianIMLS<pcl::PointNormal> imls;
  imls.setInputCloud (points);
  imls.addView (depth_image);
  imls.addSupportPlane (table);
  imls.reconstruct (mesh);
  if (mesh.polygons.empty ())
    return nullptr; // the console says why

  pcl::cosection::saveMesh (imls.getTriangleMesh (), "ball.ply");
  return imls.getSignedDistance ();
}

bool
theNextObject (const pcl::PointCloud<pcl::PointNormal>::ConstPtr& points,
               const pcl::cosection::SignedDistanceField::ConstPtr& ball_sdf, const Eigen::Isometry3d& T_ball_object,
               pcl::PolygonMesh& mesh)
{
  pcl::cosection::HessianIMLS<pcl::PointNormal> imls;
  imls.setInputCloud (points);
  imls.addObstacle (ball_sdf, {T_ball_object});
  imls.reconstruct (mesh);
  for (const auto& vertex : imls.getTriangleMesh ().vertices)
    if (ball_sdf->sample (T_ball_object * vertex.cast<double> ()).value_or (0.0f) < -0.01f)
      return false; // a centimetre inside the ball
  return !mesh.polygons.empty ();
}

} // namespace

int
main ()
{
  const pcl::PointCloud<pcl::PointXYZ> depth_image = depthImage ();
  const auto points = ball (depth_image);
  pcl::PolygonMesh mesh;
  poisson (points, mesh);
  std::cout << "pcl::Poisson: " << mesh.polygons.size () << " triangles\n";
  const auto sdf = hessianImls (points, depth_image, mesh);
  if (!sdf)
    return 1;
  std::cout << "HessianIMLS: " << mesh.polygons.size () << " triangles\n";

  Eigen::Isometry3d T_ball_object = Eigen::Isometry3d::Identity ();
  T_ball_object.translation ().z () = -1.5 * radius; // in front of the first
  return theNextObject (points, sdf, T_ball_object, mesh) ? 0 : 1;
}
