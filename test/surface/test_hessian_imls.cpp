// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "volume/analytic_fields.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

using namespace pcl::cosection;

namespace
{

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Imls = HessianIMLS<pcl::PointNormal>;

constexpr float radius = 0.1f;
constexpr float voxel = 0.01f;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN ();

/** \brief Points spread evenly over the part of a sphere about the origin that a sensor far up the z axis
 * sees, or over all of it. */
template <typename PointT = pcl::PointNormal> typename pcl::PointCloud<PointT>::Ptr
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

bool
closed (const TriangleMesh& mesh)
{
  return !mesh.empty () && computeTopology (mesh).closed_manifold;
}

TriangleMesh
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

pcl::PolygonMesh
reconstruct (Imls& imls)
{
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  return mesh;
}

float
lowest (const TriangleMesh& mesh)
{
  float z = std::numeric_limits<float>::infinity ();
  for (const Eigen::Vector3f& v : mesh.vertices)
    z = std::min (z, v.z ());
  return z;
}

SignedDistanceField::ConstPtr
ballField (double ball_radius)
{
  return std::make_shared<SignedDistanceField> (test::sampleField (test::sphere (ball_radius), 0.1, 0.005));
}

/** \brief As after a failure: nothing at all. */
void
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

pcl::ModelCoefficients
planeAt (float z, float scale)
{
  pcl::ModelCoefficients plane;
  plane.values = {0.0f, 0.0f, scale, -scale * z};
  return plane;
}

} // namespace

// --- A drop-in for pcl::Poisson --------------------------------------------------------------------------------------

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

// --- Input that determines no surface --------------------------------------------------------------------------------

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

// --- Constraints -----------------------------------------------------------------------------------------------------

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
  up.setSupportPlane (planeAt (height, 1.0f));
  down.setSupportPlane (planeAt (height, -2.5f));
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
  const Eigen::Vector3d positions[] = {{0.04, 0.0, -0.088}, {-0.04, 0.0, -0.088}};
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
  imls.addIntersection (ballField (ball_radius), poses);
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
  second.addIntersection (body, {T_first_second});
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
  EXPECT_THROW (imls.setVoxelSize (0.0f), InvalidArgument);
  EXPECT_THROW (imls.setVoxelSize (not_a_number), InvalidArgument);
  EXPECT_THROW (imls.setResolution (-1), InvalidArgument);
  EXPECT_THROW (imls.addIntersection (nullptr), InvalidArgument);
  EXPECT_THROW (imls.addView (DepthView ()), InvalidArgument);
  EXPECT_THROW (imls.setSupportPlane (pcl::ModelCoefficients ()), InvalidArgument);
  EXPECT_THROW (imls.setSupportPlane (planeAt (1.0f, 0.0f)), InvalidArgument);
  EXPECT_THROW (imls.setSupportPlane (planeAt (not_a_number, 1.0f)), InvalidArgument);
}
