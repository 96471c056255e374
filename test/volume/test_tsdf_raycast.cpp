// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "tsdf_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_raycast.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace pcl::cosection;

namespace {

constexpr double voxel_size_m = 0.005;

/** \brief Remove readings at grazing angles, where a distance along the ray differs from that to the surface. */
Image<float>
frontal (const Image<float>& depth, const PinholeCamera& camera)
{
  Image<float> kept (depth.width, depth.height, std::numeric_limits<float>::quiet_NaN ());
  for (int v = 1; v + 1 < depth.height; ++v)
    for (int u = 1; u + 1 < depth.width; ++u)
    {
      const auto point = [&] (int column, int row) { return camera.unproject (column, row, depth.at (column, row)); };
      const Eigen::Vector3d
          normal = (point (u + 1, v) - point (u - 1, v)).cross (point (u, v + 1) - point (u, v - 1)).normalized ();
      if (normal.dot (point (u, v).normalized ()) > 0.7)
        kept.at (u, v) = depth.at (u, v);
    }
  return kept;
}

/** \brief Depth of the surface along a ray, by small steps. */
double
searchedDepth (const TsdfVolume& volume, const PinholeCamera& camera, const Eigen::Isometry3d& pose, int u, int v)
{
  const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
  const double step = 0.1 * voxel_size_m / ray.norm ();
  double before = std::numeric_limits<double>::quiet_NaN ();
  for (double z = 0.0; z < 1.0; z += step)
  {
    const Eigen::Vector3d p = pose * (z * ray).eval ();
    const auto cell = volume.sample (p);
    const double value = (cell ? cell->value () : std::numeric_limits<double>::quiet_NaN ());
    if (before > 0.0 && value <= 0.0)
      return z - step * value / (value - before);
    if (before <= 0.0 && value > 0.0)
      break;
    before = value;
  }
  return std::numeric_limits<double>::quiet_NaN ();
}

/** \brief The TSDF of a scene from some sensors, with surfaces seen at less than 45 degrees. */
TsdfVolume
fused (const test::RayLength& scene, const std::vector<Eigen::Isometry3d>& poses, int dim = 60)
{
  TsdfOptions options;
  options.truncation_vox = 6.0;
  TsdfVolume volume (test::cubeGrid (dim, voxel_size_m), options);
  const PinholeCamera camera{640, 480, 900.0, 900.0, 319.5, 239.5};
  for (const auto& pose : poses)
    volume.integrate (frontal (test::renderDepth (scene, camera, pose), camera), camera, pose);
  return volume;
}

std::vector<Eigen::Isometry3d>
frontPoses ()
{
  std::vector<Eigen::Isometry3d> poses;
  for (const double x : {-0.1, 0.0, 0.1})
    poses.push_back (test::lookAtOrigin ({x, 0.05, -0.5}));
  return poses;
}

std::size_t
countHits (const RaycastImage& image)
{
  return std::count_if (image.depth.pixels.begin (), image.depth.pixels.end (),
                        [] (float z) { return !std::isnan (z); });
}

/** \brief Expect that hit pixels agree with the scene where it is seen at less than 60 degrees; its normals are given.
 */
template <typename Normal>
void
expectScene (const RaycastImage& image, const test::RayLength& scene, const Eigen::Isometry3d& pose,
             const Normal& normalAt, double share)
{
  const Image<float> truth = test::renderDepth (scene, image.camera, pose);
  int frontal = 0;
  int hits = 0;
  for (int v = 0; v < truth.height; ++v)
    for (int u = 0; u < truth.width; ++u)
    {
      if (std::isnan (truth.at (u, v)))
        continue;
      const Eigen::Vector3d p = image.camera.unproject (u, v, truth.at (u, v));
      const Eigen::Vector3d normal = pose.linear ().transpose () * normalAt (pose * p);
      if (!(-normal.dot (p.normalized ()) > 0.5))
        continue;
      ++frontal;
      if (std::isnan (image.depth.at (u, v)))
        continue;
      ++hits;
      EXPECT_NEAR (image.depth.at (u, v), truth.at (u, v), 0.2 * voxel_size_m) << u << " " << v;
      const Eigen::Vector3d seen = image.normals.at (u, v).cast<double> ();
      EXPECT_NEAR (seen.norm (), 1.0, 1e-5);
      EXPECT_GT (seen.dot (normal), std::cos (3.0 * M_PI / 180.0)) << u << " " << v;
      EXPECT_GT (image.weights.at (u, v), 0.0f);
      EXPECT_EQ (image.ids.at (u, v), 0);
    }
  EXPECT_GT (frontal, 500);
  EXPECT_GE (hits, share * frontal);
}

RaycastOptions
everything ()
{
  RaycastOptions options;
  options.normals = true;
  options.weights = true;
  return options;
}

template <typename Pixel>
bool
sameBytes (const Image<Pixel>& a, const Image<Pixel>& b)
{
  return a.pixels.size () == b.pixels.size () &&
         std::memcmp (static_cast<const void*> (a.pixels.data ()), static_cast<const void*> (b.pixels.data ()),
                      a.pixels.size () * sizeof (Pixel)) == 0;
}

} // namespace

TEST (TsdfRaycast, ASphereIsWhereItIs)
{
  const auto scene = test::sphereRay (0.08);
  std::vector<Eigen::Isometry3d> poses = test::posesAround (0.5);
  const Eigen::Isometry3d turn (Eigen::AngleAxisd (0.25 * M_PI, Eigen::Vector3d (1.0, 1.0, 0.0).normalized ()));
  for (const auto& pose : test::posesAround (0.5))
    poses.push_back (turn * pose);
  const TsdfVolume volume = fused (scene, poses);
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d (0.1, -0.3, -0.35), Eigen::Vector3d (0.0, 0.0, 0.4)})
  {
    const auto pose = test::lookAtOrigin (eye);
    const auto image = raycast (volume, test::smallCamera (), pose, everything ());
    expectScene (
        image, scene, pose, [] (const Eigen::Vector3d& p) { return p.normalized (); }, 1.0);
  }
}

TEST (TsdfRaycast, APlaneIsSeenFromWithinTheVolume)
{
  const Eigen::Vector3d normal = Eigen::Vector3d (0.2, -0.3, -1.0).normalized ();
  const auto scene = test::planeRay (normal, -0.03);
  const TsdfVolume volume = fused (scene, frontPoses ());
  const auto normalAt = [&] (const Eigen::Vector3d&) { return normal; };
  for (const double z : {-0.1, -0.3}) // within and outside
  {
    auto pose = test::frontPose ();
    pose.translation ().z () = z;
    const auto image = raycast (volume, test::smallCamera (), pose, everything ());
    expectScene (image, scene, pose, normalAt, 0.5); // the plane is larger than the volume
    EXPECT_FALSE (std::isnan (image.depth.at (80, 60)));
  }
}

TEST (TsdfRaycast, FindsWhatSmallStepsFind)
{
  const auto scene = test::nearerRay (test::sphereRay (0.05, {0.02, 0.0, -0.05}),
                                      test::planeRay ({0.1, 0.0, 1.0}, 0.1));
  const TsdfVolume volume = fused (scene, frontPoses ());
  const PinholeCamera camera = test::smallCamera ();
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d (0.02, 0.0, -0.45), Eigen::Vector3d (-0.3, 0.1, -0.25), Eigen::Vector3d (0.1, -0.1, -0.12)})
  {
    const auto pose = test::lookAtOrigin (eye);
    const auto image = raycast (volume, camera, pose);
    int found = 0;
    int different = 0; // at the rim of the known region, where a step may be longer than the known part of a ray
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        const double expected = searchedDepth (volume, camera, pose, u, v);
        const double z = image.depth.at (u, v);
        found += !std::isnan (expected);
        different += (std::isnan (z) != std::isnan (expected) || std::abs (z - expected) > 0.05 * voxel_size_m);
      }
    EXPECT_GT (found, 1000) << eye.transpose ();
    EXPECT_LT (different, 0.03 * found) << eye.transpose ();
  }
}

TEST (TsdfRaycast, NothingIsSeenOfWhatIsNotThere)
{
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.0, 0.0, -0.4});
  const TsdfVolume empty (test::cubeGrid (20, 0.01));
  const auto image = raycast (empty, camera, pose, everything ());
  EXPECT_EQ (countHits (image), 0u);
  EXPECT_EQ (image.ids.at (80, 60), RaycastImage::nothing);
  EXPECT_EQ (image.normals.at (80, 60), Eigen::Vector3f::Zero ());
  EXPECT_EQ (image.weights.at (80, 60), 0.0f);
  EXPECT_EQ (countHits (raycast ({}, camera)), 0u);

  const auto scene = test::sphereRay (0.08);
  const TsdfVolume volume = fused (scene, test::posesAround (0.5), 40);
  Eigen::Isometry3d away = pose;
  away.linear () = pose.linear () * Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitY ()).toRotationMatrix ();
  EXPECT_EQ (countHits (raycast (volume, camera, away)), 0u);
  away.translation ().setZero (); // within the ball
  EXPECT_EQ (countHits (raycast (volume, camera, away)), 0u);

  VoxelGrid sheet = test::cubeGrid (20, 0.01);
  sheet.dims.z () = 1;
  TsdfVolume thin (sheet);
  thin.integrate (test::wallDepth (0.45f), camera, test::frontPose ());
  EXPECT_EQ (countHits (raycast (thin, camera, pose)), 0u);
}

TEST (TsdfRaycast, ABackIsNoSurface)
{
  const TsdfVolume volume = fused (test::planeRay (Eigen::Vector3d::UnitZ (), 0.0), frontPoses ());
  const auto behind = test::lookAtOrigin ({0.0, 0.0, 0.5});
  EXPECT_EQ (countHits (raycast (volume, test::smallCamera (), behind)), 0u);
}

TEST (TsdfRaycast, UnknownVoxelsAreNotCrossed)
{
  // Two parallel views of a wall with a hole in one; what lies behind the hole was never seen.
  const PinholeCamera camera = test::smallCamera ();
  Image<float> depth = test::wallDepth (0.5f);
  for (int v = 40; v < 80; ++v)
    for (int u = 60; u < 100; ++u)
      depth.at (u, v) = std::numeric_limits<float>::quiet_NaN ();
  TsdfVolume volume (test::cubeGrid (40, voxel_size_m));
  volume.integrate (depth, camera, test::frontPose ());
  const auto image = raycast (volume, camera, test::frontPose ());
  EXPECT_NEAR (image.depth.at (55, 60), 0.5f, 0.1 * voxel_size_m);
  for (int v = 42; v < 78; ++v)
    for (int u = 62; u < 98; ++u)
      EXPECT_TRUE (std::isnan (image.depth.at (u, v))) << u << " " << v;

  // Behind the unknown the ray goes on: a wall seen by a second, shorter-sighted sensor.
  TsdfVolume later (test::cubeGrid (40, voxel_size_m));
  Eigen::Isometry3d close = test::frontPose ();
  close.translation ().z () = -0.02;
  later.integrate (test::wallDepth (0.08f), camera, close);
  const auto through = raycast (later, camera, test::frontPose ());
  EXPECT_NEAR (through.depth.at (79, 60), 0.56f, 0.2 * voxel_size_m);
}

TEST (TsdfRaycast, TheNearestBodyIsSeen)
{
  const TsdfVolume ball = fused (test::sphereRay (0.06), test::posesAround (0.5), 40);
  const TsdfVolume wall = fused (test::planeRay (Eigen::Vector3d::UnitZ (), 0.1), frontPoses ());
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::frontPose ();
  Eigen::Isometry3d behind = pose;
  behind.translation ().z () -= 0.2; // for this sensor the ball is behind the wall
  const std::vector<RaycastBody> bodies{{&wall, pose, 0}, {&ball, pose, 7}, {&ball, behind, 8}};
  const auto seen = raycast (bodies, camera);
  EXPECT_EQ (seen.ids.at (79, 60), 7);
  EXPECT_NEAR (seen.depth.at (79, 60), 0.44f, 0.2 * voxel_size_m);
  EXPECT_EQ (seen.ids.at (50, 60), 0);
  EXPECT_EQ (std::count (seen.ids.pixels.begin (), seen.ids.pixels.end (), 8), 0);
  const auto turned = raycast ({bodies[2], bodies[1], bodies[0]}, camera);
  EXPECT_TRUE (sameBytes (seen.ids, turned.ids));
  EXPECT_TRUE (sameBytes (seen.depth, turned.depth));
  const auto twice = raycast ({{&ball, pose, 3}, {&ball, pose, 4}}, camera);
  EXPECT_EQ (twice.ids.at (79, 60), 3); // of equal ones the first
  for (std::size_t i = 0; i < seen.ids.pixels.size (); ++i)
    EXPECT_EQ (seen.ids.pixels[i] == RaycastImage::nothing, std::isnan (seen.depth.pixels[i]));
}

TEST (TsdfRaycast, OnlyTheForegroundIsSeenIfAskedFor)
{
  const auto scene = test::nearerRay (test::sphereRay (0.05, {0.0, 0.0, -0.04}),
                                      test::planeRay (Eigen::Vector3d::UnitZ (), 0.06));
  const PinholeCamera camera = test::smallCamera ();
  TsdfOptions options;
  options.foreground = true;
  TsdfVolume volume (test::cubeGrid (60, voxel_size_m), options);
  const auto pose = test::frontPose ();
  const auto depth = test::renderDepth (scene, camera, pose);
  Image<std::uint16_t> labels (camera.width, camera.height);
  for (std::size_t i = 0; i < labels.pixels.size (); ++i)
    labels.pixels[i] = (depth.pixels[i] < 0.52f);
  volume.integrate (depth, camera, pose);
  RaycastBody body{&volume, pose, 1, true};
  EXPECT_EQ (countHits (raycast ({body}, camera)), 0u); // nothing was counted
  volume.countForeground (depth, camera, pose, labels, 1);
  const auto foreground = raycast ({body}, camera);
  body.foreground_only = false;
  const auto all = raycast ({body}, camera);
  EXPECT_NEAR (foreground.depth.at (79, 60), 0.41f, 0.3 * voxel_size_m);
  EXPECT_TRUE (std::isnan (foreground.depth.at (45, 60)));
  EXPECT_NEAR (all.depth.at (45, 60), 0.56f, 0.2 * voxel_size_m);
}

TEST (TsdfRaycast, AStrideLeavesOutPixels)
{
  const TsdfVolume volume = fused (test::sphereRay (0.08), frontPoses ());
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.05, 0.0, -0.45});
  RaycastOptions options;
  const auto full = raycast (volume, camera, pose, options);
  options.stride = 3;
  const auto sparse = raycast (volume, camera, pose, options);
  ASSERT_EQ (sparse.depth.width, 54);
  ASSERT_EQ (sparse.depth.height, 40);
  EXPECT_EQ (sparse.camera.width, 54);
  for (int v = 0; v < sparse.depth.height; ++v)
    for (int u = 0; u < sparse.depth.width; ++u)
    {
      const float z = full.depth.at (3 * u, 3 * v);
      EXPECT_EQ (std::isnan (sparse.depth.at (u, v)), std::isnan (z)) << u << " " << v;
      if (!std::isnan (z))
      {
        EXPECT_NEAR (sparse.depth.at (u, v), z, 1e-5f);
      }
    }
}

TEST (TsdfRaycast, SurfacesBeyondTheLargestDepthAreNotSeen)
{
  const TsdfVolume volume = fused (test::sphereRay (0.08), test::posesAround (0.5));
  const auto pose = test::lookAtOrigin ({0.0, 0.0, -0.5});
  RaycastOptions options;
  options.max_depth_m = 0.45;
  const auto image = raycast (volume, test::smallCamera (), pose, options);
  EXPECT_GT (countHits (image), 100u);
  for (const float z : image.depth.pixels)
    EXPECT_FALSE (z > 0.45f);
  options.max_depth_m = 0.4;
  EXPECT_EQ (countHits (raycast (volume, test::smallCamera (), pose, options)), 0u);
}

TEST (TsdfRaycast, ThreadsChangeNothing)
{
  const TsdfVolume ball = fused (test::sphereRay (0.06), test::posesAround (0.5), 40);
  const TsdfVolume wall = fused (test::planeRay ({0.1, 0.1, 1.0}, 0.1), frontPoses ());
  const PinholeCamera camera{321, 243, 281.0, 281.0, 159.5, 121.5};
  const auto pose = test::frontPose ();
  const std::vector<RaycastBody> bodies{{&wall, pose, 0}, {&ball, pose, 1}};
  RaycastOptions options = everything ();
  options.threads = 1;
  const auto one = raycast (bodies, camera, options);
  for (const int threads : {2, 3, 7})
  {
    options.threads = threads;
    const auto many = raycast (bodies, camera, options);
    EXPECT_TRUE (sameBytes (one.depth, many.depth));
    EXPECT_TRUE (sameBytes (one.ids, many.ids));
    EXPECT_TRUE (sameBytes (one.normals, many.normals));
    EXPECT_TRUE (sameBytes (one.weights, many.weights));
  }
}

TEST (TsdfRaycast, RefusesWhatIsNotValid)
{
  const TsdfVolume volume (test::cubeGrid (8, 0.01));
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::frontPose ();
  EXPECT_THROW (raycast (volume, PinholeCamera (), pose), InvalidArgument);
  RaycastOptions options;
  options.stride = 0;
  EXPECT_THROW (raycast (volume, camera, pose, options), InvalidArgument);
  options = {};
  options.max_depth_m = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (raycast (volume, camera, pose, options), InvalidArgument);
  options = {};
  options.threads = -1;
  EXPECT_THROW (raycast (volume, camera, pose, options), InvalidArgument);
  EXPECT_THROW (raycast ({{nullptr, pose, 0}}, camera), InvalidArgument);
  EXPECT_THROW (raycast ({{&volume, pose, RaycastImage::nothing}}, camera), InvalidArgument);
  EXPECT_THROW (raycast ({{&volume, pose, 1, true}}, camera), InvalidArgument); // no counts
  Eigen::Isometry3d bad = pose;
  bad.linear () *= 1.1;
  EXPECT_THROW (raycast (volume, camera, bad), InvalidArgument);
  bad = pose;
  bad.translation ().x () = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (raycast (volume, camera, bad), InvalidArgument);
}
