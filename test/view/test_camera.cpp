// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

PinholeCamera
tinyCamera ()
{
  PinholeCamera camera;
  camera.width = 80;
  camera.height = 60;
  camera.fx = 71.0;
  camera.fy = 73.5;
  camera.cx = 38.2;
  camera.cy = 31.7;
  return camera;
}

/** \brief The camera's image of a bumpy scene, with Gaussian noise of \a noise_px on the pixels. */
std::vector<Eigen::Vector3f>
organizedCloud (const PinholeCamera& camera, double noise_px, double missing)
{
  std::mt19937 random (3);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> uniform;
  const float nan = std::numeric_limits<float>::quiet_NaN ();
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const double z = 0.8 + uniform (random);
      const Eigen::Vector3d p = camera.unproject (u + noise_px * noise (random), v + noise_px * noise (random), z);
      points.push_back (p.cast<float> ());
      if (uniform (random) < missing)
        points.back ().setConstant (nan);
    }
  return points;
}

} // namespace

TEST (PinholeCamera, ProjectInvertsUnproject)
{
  const auto camera = tinyCamera ();
  EXPECT_TRUE (camera.project (camera.unproject (12.5, 40.0, 0.7)).isApprox (Eigen::Vector2d (12.5, 40.0)));
}

TEST (PinholeCamera, ValidateRefusesImpossibleParameters)
{
  EXPECT_NO_THROW (tinyCamera ().validate ());
  EXPECT_THROW (PinholeCamera ().validate (), InvalidArgument);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN (), std::numeric_limits<double>::infinity ()})
  {
    auto camera = tinyCamera ();
    camera.fy = bad;
    EXPECT_THROW (camera.validate (), InvalidArgument);
  }
  auto camera = tinyCamera ();
  camera.height = 0;
  EXPECT_THROW (camera.validate (), InvalidArgument);
  camera = tinyCamera ();
  camera.cx = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (camera.validate (), InvalidArgument);
}

TEST (FitPinholeCamera, FindsTheCameraDespiteMissingReadings)
{
  const auto truth = tinyCamera ();
  for (const double missing : {0.0, 0.5, 0.97})
  {
    const auto fitted = fitPinholeCamera (organizedCloud (truth, 0.0, missing), truth.width, truth.height);
    ASSERT_TRUE (fitted.has_value ());
    EXPECT_EQ (fitted->width, truth.width);
    EXPECT_EQ (fitted->height, truth.height);
    EXPECT_NEAR (fitted->fx, truth.fx, 1e-3);
    EXPECT_NEAR (fitted->fy, truth.fy, 1e-3);
    EXPECT_NEAR (fitted->cx, truth.cx, 1e-3);
    EXPECT_NEAR (fitted->cy, truth.cy, 1e-3);
  }
}

TEST (FitPinholeCamera, AcceptsResidualsUpToHalfAPixel)
{
  const auto truth = tinyCamera ();
  const auto fitted = fitPinholeCamera (organizedCloud (truth, 0.3, 0.1), truth.width, truth.height);
  ASSERT_TRUE (fitted.has_value ());
  EXPECT_NEAR (fitted->fx, truth.fx, 0.2);
  EXPECT_NEAR (fitted->cx, truth.cx, 0.1);
  EXPECT_FALSE (fitPinholeCamera (organizedCloud (truth, 0.4, 0.1), truth.width, truth.height).has_value ());
}

TEST (FitPinholeCamera, RefusesWhatIsNoPinholeImage)
{
  const auto camera = tinyCamera ();
  EXPECT_FALSE (fitPinholeCamera (organizedCloud (camera, 0.0, 0.995), 80, 60).has_value ()); // too few
  EXPECT_FALSE (fitPinholeCamera (std::vector<Eigen::Vector3f> (4800, {0.1f, 0.2f, 1.0f}), 80, 60).has_value ());
  EXPECT_FALSE (fitPinholeCamera (std::vector<Eigen::Vector3f> (4800, {0.0f, 0.0f, 0.0f}), 80, 60).has_value ());
  auto mirrored = organizedCloud (camera, 0.0, 0.0);
  for (auto& p : mirrored)
    p.x () = -p.x ();
  EXPECT_FALSE (fitPinholeCamera (mirrored, 80, 60).has_value ());
  std::vector<Eigen::Vector3f> orthographic;
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u)
      orthographic.emplace_back (0.01f * u - 0.4f, 0.01f * v - 0.3f,
                                 1.0f + 0.02f * static_cast<float> ((u * 7 + v * 13) % 20));
  EXPECT_FALSE (fitPinholeCamera (orthographic, 80, 60).has_value ());
  // an unorganised cloud: one row
  EXPECT_FALSE (fitPinholeCamera (organizedCloud (camera, 0.0, 0.0), 4800, 1).has_value ());
  EXPECT_THROW (fitPinholeCamera ({}, 80, 60), InvalidArgument);
}
