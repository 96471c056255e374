// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "imls_sphere.h"
#include "lowest_vertex.h"
#include "volume/analytic_fields.h"

#include <limits>
#include <memory>

// HessianIMLS with views, bodies and support planes.

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A sphere about the origin in front of a wall, as seen along z from \a distance_m. */
pcl::PointCloud<pcl::PointXYZ>
organisedView (double distance_m)
{
  constexpr int size = 120;
  constexpr double focal_px = 200.0;
  const double wall_z = distance_m + 0.5;
  pcl::PointCloud<pcl::PointXYZ> cloud (size, size);
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u)
    {
      const Eigen::Vector3d ray ((u - 59.5) / focal_px, (v - 59.5) / focal_px, 1.0);
      // |z ray - (0, 0, distance)|^2 = radius^2
      const double a = ray.squaredNorm ();
      const double discriminant = distance_m * distance_m - a * (distance_m * distance_m - radius * radius);
      const double z = discriminant > 0.0 ? (distance_m - std::sqrt (discriminant)) / a : wall_z;
      cloud (u, v).getVector3fMap () = (z * ray).cast<float> ();
    }
  return cloud;
}

/** \brief Where the sensor of organisedView () is: up the z axis, looking down. */
Eigen::Isometry3d
sensorAbove (double distance_m)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.linear () = Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitX ()).toRotationMatrix ();
  T.translation ().z () = distance_m;
  return T;
}

SignedDistanceField::ConstPtr
ballField (double ball_radius)
{
  return std::make_shared<SignedDistanceField> (test::sampleField (test::sphere (ball_radius), 0.1, 0.005));
}

pcl::ModelCoefficients
planeAt (float z, float scale)
{
  pcl::ModelCoefficients plane;
  plane.values = {0.0f, 0.0f, scale, -scale * z};
  return plane;
}

} // namespace

TEST (HessianImlsConstraints, ViewOfAnOrganisedCloudIsFreeSpace)
{
  constexpr double distance = 0.6;
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setVoxelSize (voxel);
  ASSERT_TRUE (imls.addView (organisedView (distance), sensorAbove (distance)));
  const TriangleMesh mesh = toTriangleMesh (reconstruct (imls));
  EXPECT_TRUE (closed (mesh));
  // Nothing beside the cone of rays that touch the sphere.
  const double slope = radius / std::sqrt (distance * distance - radius * radius);
  for (const Eigen::Vector3f& v : mesh.vertices)
    EXPECT_LT (v.head<2> ().norm (), (distance - v.z ()) * slope + 3.5 * voxel);
}

TEST (HessianImlsConstraints, ViewMustBeAPinholesImage)
{
  Imls imls;
  EXPECT_FALSE (imls.addView (*sphereCloud (true)));
  pcl::PointCloud<pcl::PointXYZ> scrambled = organisedView (0.6);
  std::reverse (scrambled.begin (), scrambled.begin () + static_cast<std::ptrdiff_t> (scrambled.size () / 2));
  EXPECT_FALSE (imls.addView (scrambled));
  imls.setInputCloud (sphereCloud (true));
  EXPECT_TRUE (closed (toTriangleMesh (reconstruct (imls))));
}

TEST (HessianImlsConstraints, SupportPlaneOfEitherSign)
{
  Imls up, down, none;
  for (Imls* imls : {&up, &down, &none})
  {
    imls->setInputCloud (sphereCloud (true));
    imls->setVoxelSize (voxel);
  }
  const float height = -0.4f * radius;
  up.addSupportPlane (planeAt (height, 1.0f));
  down.addSupportPlane (planeAt (height, -2.5f));
  const pcl::PolygonMesh mesh = reconstruct (up);
  EXPECT_TRUE (closed (toTriangleMesh (mesh)));
  EXPECT_LT (lowest (toTriangleMesh (reconstruct (none))), height - voxel);
  EXPECT_GT (lowest (toTriangleMesh (mesh)), height - voxel);
  EXPECT_EQ (mesh.cloud.data, reconstruct (down).cloud.data);
  up.clearConstraints ();
  EXPECT_EQ (reconstruct (none).cloud.data, reconstruct (up).cloud.data);
}

TEST (HessianImlsConstraints, KeepsOutOfABodyAtEveryPose)
{
  // A ball below the object on one side, then on the other.
  constexpr double ball_radius = 0.04;
  const Eigen::Vector3d positions[] = {{0.04, 0.0, -0.08}, {-0.04, 0.0, -0.08}};
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Vector3d& p : positions)
    poses.emplace_back (Eigen::Translation3d (-p)); // T_body_object
  const auto deepest = [&] (const TriangleMesh& mesh, const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Vector3f& v : mesh.vertices)
      depth = std::max (depth, ball_radius - (v.cast<double> () - at).norm ());
    return depth;
  };
  Imls imls;
  imls.setInputCloud (sphereCloud (true));
  imls.setVoxelSize (0.005f);
  const TriangleMesh free = toTriangleMesh (reconstruct (imls));
  imls.addObstacle (ballField (ball_radius), poses);
  const TriangleMesh bounded = toTriangleMesh (reconstruct (imls));
  EXPECT_TRUE (closed (bounded));
  for (const Eigen::Vector3d& at : positions)
  {
    EXPECT_GT (deepest (free, at), 0.01) << "the balls are not in the way";
    EXPECT_LT (deepest (bounded, at), 0.005);
  }
}

TEST (HessianImlsConstraints, SignedDistanceServesTheNextObject)
{
  Imls first;
  first.setInputCloud (sphereCloud (false));
  first.setVoxelSize (voxel);
  reconstruct (first);
  const SignedDistanceField::ConstPtr body = first.getSignedDistance ();
  ASSERT_NE (nullptr, body);
  EXPECT_NEAR (0.0, body->sample ({0.0, 0.0, radius}).value (), 0.5 * voxel);

  // The same ball again, less than one and a half radii farther up: it would reach into the first.
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity ();
  T_first_second.translation ().z () = 1.45 * radius;
  Imls second;
  second.setInputCloud (sphereCloud (true));
  second.setVoxelSize (voxel);
  const float before = lowest (toTriangleMesh (reconstruct (second)));
  second.addObstacle (body, {T_first_second});
  const TriangleMesh mesh = toTriangleMesh (reconstruct (second));
  EXPECT_TRUE (closed (mesh));
  double deepest = 0.0, deepest_before = radius - (before + T_first_second.translation ().z ());
  for (const Eigen::Vector3f& v : mesh.vertices)
    deepest = std::max (deepest, radius - (T_first_second * v.cast<double> ()).norm ());
  EXPECT_GT (deepest_before, voxel);
  EXPECT_LT (deepest, voxel);
}

TEST (HessianImlsConstraints, SettersRefuseNonsense)
{
  Imls imls;
  EXPECT_FALSE (imls.setVoxelSize (0.0f));
  EXPECT_FALSE (imls.setVoxelSize (not_a_number));
  EXPECT_FALSE (imls.setResolution (-1));
  EXPECT_FALSE (imls.addObstacle (nullptr));
  EXPECT_FALSE (imls.addView (DepthView ()));
  DepthView scaled;
  scaled.camera = {2, 2, 1.0, 1.0, 0.5, 0.5};
  scaled.depth.assign (4, 1.0f);
  EXPECT_TRUE (imls.addView (scaled));
  scaled.T_world_sensor.linear () *= 2.0;
  EXPECT_FALSE (imls.addView (scaled));
  EXPECT_FALSE (imls.addSupportPlane (pcl::ModelCoefficients ()));
  EXPECT_FALSE (imls.addSupportPlane (planeAt (1.0f, 0.0f)));
  EXPECT_FALSE (imls.addSupportPlane (planeAt (not_a_number, 1.0f)));
}
