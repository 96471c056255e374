// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "completion/analytic_scene.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/normals.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Depth along the ray (x, y, 1); NaN: no reading. */
using DepthFunction = std::function<double (double x, double y)>;

std::vector<Eigen::Vector3f>
render (const PinholeCamera& camera, const DepthFunction& depth, double noise_scale = 0.0)
{
  std::mt19937 generator (1);
  std::normal_distribution<double> gauss;
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      double z = depth (ray.x (), ray.y ());
      z += noise_scale * depthNoiseSigma (z) * gauss (generator);
      points.push_back ((ray * z).cast<float> ());
    }
  return (points);
}

DepthFunction
planeDepth (const Eigen::Vector3d& normal, double offset)
{
  return ([=] (double x, double y) { return (offset / normal.dot (Eigen::Vector3d (x, y, 1.0))); });
}

double
angle (const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  return (std::acos (std::min (1.0f, std::max (-1.0f, a.dot (b)))));
}

bool
valid (const Eigen::Vector3f& n)
{
  return (n.allFinite ());
}

} // namespace

class TiltedPlane : public testing::TestWithParam<double>
{};

TEST_P (TiltedPlane, HasItsNormalEverywhere)
{
  const double tilt = GetParam () * M_PI / 180.0;
  const Eigen::Vector3d normal (std::sin (tilt), 0.0, std::cos (tilt));
  const PinholeCamera camera = smallCamera ();
  const auto points = render (camera, planeDepth (normal, std::cos (tilt)));
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  int count = 0;
  for (int v = 10; v < camera.height - 10; ++v)
    for (int u = 60; u < camera.width - 60; ++u)
    {
      const Eigen::Vector3f& n = normals[v * camera.width + u];
      if (!valid (n))
        continue;
      ++count;
      EXPECT_NEAR (n.norm (), 1.0f, 1e-5f);
      EXPECT_LT (angle (n, -normal.cast<float> ()), 1e-3);
    }
  EXPECT_EQ (count, (camera.height - 20) * (camera.width - 120));
}

INSTANTIATE_TEST_SUITE_P (Degrees, TiltedPlane, testing::Values (0.0, 30.0, -50.0, 65.0, -70.0));

TEST (OrganizedNormals, GrazingPlaneHasNone)
{
  const double tilt = 88.0 * M_PI / 180.0;
  const PinholeCamera camera = smallCamera ();
  const auto points = render (camera, planeDepth ({0.0, std::sin (tilt), std::cos (tilt)}, std::cos (tilt)));
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  for (int u = 0; u < camera.width; ++u)
    EXPECT_FALSE (valid (normals[60 * camera.width + u]));
}

TEST (OrganizedNormals, NoisySphereIsNearTheTruth)
{
  const PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  const Eigen::Vector3d centre (0.0, 0.0, 1.0);
  const double radius = 0.15;
  const auto points = render (
      camera,
      [&] (double x, double y) {
        const Eigen::Vector3d d = Eigen::Vector3d (x, y, 1.0);
        const double a = d.squaredNorm (), b = d.dot (centre), c = centre.squaredNorm () - radius * radius;
        const double root = b * b - a * c;
        return (root > 0.0 ? (b - std::sqrt (root)) / a : std::numeric_limits<double>::quiet_NaN ());
      },
      1.0);
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  double sum = 0.0;
  int count = 0, frontal = 0, pixels = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points[i].allFinite ())
    {
      EXPECT_FALSE (valid (normals[i]));
      continue;
    }
    const Eigen::Vector3f truth = (points[i] - centre.cast<float> ()).normalized ();
    const bool facing = truth.dot (-points[i].normalized ()) > 0.5f;
    pixels += facing;
    if (!valid (normals[i]))
      continue;
    frontal += facing;
    ++count;
    sum += angle (normals[i], truth);
  }
  EXPECT_GT (frontal, 0.98 * pixels);
  EXPECT_LT (sum / count, 5.0 * M_PI / 180.0);
}

class StepEdge : public testing::TestWithParam<double>
{};

TEST_P (StepEdge, DoesNotBendTheNormals)
{
  const double step = GetParam ();
  const PinholeCamera camera = smallCamera ();
  auto points = render (camera, [&] (double x, double) { return (x < 0.0 ? 1.0 : 1.0 + step); });
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  int found = 0;
  for (int v = 10; v < camera.height - 10; ++v)
    for (int u = 70; u < 90; ++u)
    {
      const Eigen::Vector3f& n = normals[v * camera.width + u];
      if (!valid (n))
        continue;
      ++found;
      EXPECT_LT (angle (n, -Eigen::Vector3f::UnitZ ()), 0.02) << "column " << u;
    }
  EXPECT_GT (found, 0.9 * 20 * (camera.height - 20));
}

INSTANTIATE_TEST_SUITE_P (Metres, StepEdge, testing::Values (0.06, 0.1, 0.5));

TEST (OrganizedNormals, FlyingPixelsHaveNone)
{
  const PinholeCamera camera = smallCamera ();
  auto points = render (camera, [] (double x, double) { return (x < 0.0 ? 1.0 : 1.3); });
  for (int v = 0; v < camera.height; ++v) // column 80 lies between the two planes
    points[v * camera.width + 80] = camera.unproject (80, v, 1.15).cast<float> ();
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    EXPECT_FALSE (valid (normals[v * camera.width + 80]));
}

TEST (OrganizedNormals, LabelsSeparate)
{
  // A roof: without labels its ridge is smoothed, with labels each side keeps its own normal.
  const PinholeCamera camera = smallCamera ();
  const auto points = render (camera, [] (double x, double) { return (1.0 / (1.0 + 0.8 * std::abs (x))); });
  std::vector<std::uint32_t> labels (points.size ());
  for (std::size_t i = 0; i < points.size (); ++i)
    labels[i] = points[i].x () < 0.0f ? 1 : 2;
  const Eigen::Vector3f left = Eigen::Vector3f (0.8f, 0.0f, -1.0f).normalized ();
  const Eigen::Vector3f right = Eigen::Vector3f (-0.8f, 0.0f, -1.0f).normalized ();
  const auto with = computeOrganizedNormals (points, camera.width, camera.height, labels);
  const auto without = computeOrganizedNormals (points, camera.width, camera.height);
  const int ridge = 60 * camera.width + 79;
  ASSERT_TRUE (valid (with[ridge]) && valid (with[ridge + 1]) && valid (without[ridge]));
  EXPECT_LT (angle (with[ridge], left), 1e-3);
  EXPECT_LT (angle (with[ridge + 1], right), 1e-3);
  EXPECT_GT (angle (without[ridge], left), 0.1);
}

TEST (OrganizedNormals, HolesAreHoles)
{
  const PinholeCamera camera = smallCamera ();
  auto points = render (camera, planeDepth ({0.0, 0.3, 1.0}, 1.0));
  std::mt19937 generator (3);
  for (auto& p : points)
    if (generator () % 4 == 0)
      p.setConstant (not_a_number);
  const auto normals = computeOrganizedNormals (points, camera.width, camera.height);
  int good = 0, readings = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points[i].allFinite ())
    {
      EXPECT_FALSE (valid (normals[i]));
      continue;
    }
    ++readings;
    good += valid (normals[i]);
  }
  EXPECT_GT (good, 0.95 * readings);
}

TEST (OrganizedNormals, NothingReadNothingFound)
{
  const std::vector<Eigen::Vector3f> points (64 * 48, Eigen::Vector3f::Constant (not_a_number));
  for (const auto& n : computeOrganizedNormals (points, 64, 48))
    EXPECT_FALSE (valid (n));
  const std::vector<Eigen::Vector3f> origin (64 * 48, Eigen::Vector3f::Zero ());
  for (const auto& n : computeOrganizedNormals (origin, 64, 48))
    EXPECT_FALSE (valid (n));
}

TEST (OrganizedNormals, SameForAnyNumberOfThreads)
{
  const PinholeCamera camera = smallCamera ();
  const auto points = render (camera, planeDepth ({0.4, 0.3, 1.0}, 1.0), 1.0);
  OrganizedNormalsOptions options;
  options.threads = 1;
  const auto one = computeOrganizedNormals (points, camera.width, camera.height, {}, options);
  options.threads = 5;
  const auto five = computeOrganizedNormals (points, camera.width, camera.height, {}, options);
  EXPECT_EQ (0, std::memcmp (one.data (), five.data (), one.size () * sizeof (one[0])));
}

TEST (OrganizedNormals, RefusesWrongArguments)
{
  const std::vector<Eigen::Vector3f> points (12, Eigen::Vector3f::Zero ());
  EXPECT_THROW (computeOrganizedNormals (points, 5, 3), InvalidArgument);
  EXPECT_THROW (computeOrganizedNormals (points, -4, -3), InvalidArgument);
  EXPECT_THROW (computeOrganizedNormals (points, 4, 3, {1, 2}), InvalidArgument);
  OrganizedNormalsOptions options;
  options.max_radius_px = 100;
  EXPECT_THROW (computeOrganizedNormals (points, 4, 3, {}, options), InvalidArgument);
}
