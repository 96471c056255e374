// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Reading of unorganised clouds: the place of their sensor, and the signs of their normals.

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr float radius_m = 0.1f;
const Eigen::Vector3f middle (0.02f, -0.01f, 0.8f);

/** \brief Random points of a ball, either of its side near to a sensor at the origin, or of all of it. */
pcl::PointCloud<pcl::PointNormal>
ball (int count, bool near_side_only, float noise_m = 0.0f)
{
  std::mt19937 random (3);
  std::normal_distribution<float> gauss;
  pcl::PointCloud<pcl::PointNormal> cloud;
  while (static_cast<int> (cloud.size ()) < count)
  {
    const Eigen::Vector3f n = Eigen::Vector3f (gauss (random), gauss (random), gauss (random)).normalized ();
    const Eigen::Vector3f p = middle + (radius_m + noise_m * gauss (random)) * n;
    if (!near_side_only || n.dot (-p.normalized ()) > 0.1f)
      cloud.emplace_back (p.x (), p.y (), p.z (), n.x (), n.y (), n.z ());
  }
  return cloud;
}

class UnorganizedView : public testing::Test
{
protected:
  template <typename PointT> std::string save (const pcl::PointCloud<PointT>& cloud) const
  {
    const std::string path = folder_.file ("cloud.pcd");
    pcl::io::savePCDFileBinary (path, cloud);
    return path;
  }

  template <typename PointT>
  LabelledView read (const pcl::PointCloud<PointT>& cloud, const PcdViewOptions& options = {}) const
  {
    return readPcdView (save (cloud), options);
  }

  /** \brief Share of points whose normals are within \a cosine of the ball's. */
  static double outward (const LabelledView& view, double cosine = 0.7, const Eigen::Vector3f& center = middle)
  {
    const auto& points = view.objects.at (1).points;
    double good = 0.0;
    for (const OrientedPoint& p : points)
      good += p.normal.dot ((p.position - center).normalized ()) > cosine;
    return good / static_cast<double> (points.size ());
  }

  static pcl::PointCloud<pcl::PointXYZ> withoutNormals (const pcl::PointCloud<pcl::PointNormal>& cloud)
  {
    pcl::PointCloud<pcl::PointXYZ> bare;
    for (const auto& p : cloud)
      bare.emplace_back (p.x, p.y, p.z);
    bare.sensor_origin_ = cloud.sensor_origin_;
    bare.sensor_orientation_ = cloud.sensor_orientation_;
    return bare;
  }

  TemporaryFolder folder_;
};

bool
mentions (const LabelledView& view, const std::string& text)
{
  for (const std::string& warning : view.warnings)
    if (warning.find (text) != std::string::npos)
      return true;
  return false;
}

} // namespace

TEST_F (UnorganizedView, BeforeTheSensorGivesFreeSpace)
{
  const LabelledView view = read (withoutNormals (ball (4000, true)));
  ASSERT_TRUE (view.view);
  EXPECT_TRUE (view.warnings.empty ());
  EXPECT_GT (outward (view), 0.99);
  double nearest = std::numeric_limits<double>::infinity ();
  for (const float z : view.view->depth)
    if (std::isfinite (z))
      nearest = std::min (nearest, static_cast<double> (z));
  EXPECT_NEAR (nearest, middle.norm () - radius_m, 0.005);
}

TEST_F (UnorganizedView, ViewpointOfTheHeaderCounts)
{
  auto cloud = withoutNormals (ball (4000, true));
  cloud.sensor_origin_ << 1.0f, 2.0f, 3.0f, 1.0f;
  const LabelledView view = read (cloud);
  ASSERT_TRUE (view.view);
  EXPECT_LT ((view.view->T_world_sensor.translation () - Eigen::Vector3d (1, 2, 3)).norm (), 1e-6);
  EXPECT_GT (outward (view, 0.7, middle + Eigen::Vector3f (1, 2, 3)), 0.99);
}

TEST_F (UnorganizedView, AllAroundNeighboursAgree)
{
  const LabelledView view = read (withoutNormals (ball (4000, false)));
  EXPECT_FALSE (view.view); // the far side is hidden from the origin
  EXPECT_TRUE (mentions (view, "is not known"));
  EXPECT_GT (outward (view), 0.99);
}

TEST_F (UnorganizedView, WrongViewpointIsSaid)
{
  auto cloud = ball (4000, false);
  cloud.sensor_origin_ << 0.0f, 0.0f, -0.5f, 1.0f;
  const LabelledView view = read (cloud);
  EXPECT_FALSE (view.view);
  EXPECT_TRUE (mentions (view, "not seen from its VIEWPOINT"));
  EXPECT_GT (view.objects.at (1).points.size (), 3900u);
}

/** \brief PCL's convention: the viewpoint is in the frame of the points. */
TEST_F (UnorganizedView, PointsInTheWorldFrameAreFound)
{
  const Eigen::Isometry3f T = Eigen::Translation3f (0.8f, -0.6f, 0.5f) *
                              Eigen::AngleAxisf (2.5f, Eigen::Vector3f (1, 2, -1).normalized ());
  pcl::PointCloud<pcl::PointNormal> cloud; // of two balls, one of which hides the other from the frame's origin
  for (const float behind : {0.0f, 0.4f})
    for (auto p : ball (8000, false))
    {
      p.getVector3fMap () += behind * middle.normalized ();
      if (p.getNormalVector3fMap ().dot ((T.translation () - p.getVector3fMap ()).normalized ()) > 0.1f)
        cloud.push_back (p);
    }
  cloud.sensor_origin_.head<3> () = T.translation ();
  cloud.sensor_orientation_ = Eigen::Quaternionf (T.linear ());
  for (const bool normals : {true, false})
  {
    SCOPED_TRACE (normals);
    const LabelledView view = normals ? read (cloud) : read (withoutNormals (cloud));
    ASSERT_TRUE (view.view);
    EXPECT_LT ((view.view->T_world_sensor.translation () - T.translation ().cast<double> ()).norm (), 1e-5);
    const auto& points = view.objects.at (1).points;
    ASSERT_EQ (points.size (), cloud.size ());
    std::size_t as_given = 0;
    for (std::size_t i = 0; i < points.size (); ++i)
    {
      ASSERT_LT ((points[i].position - cloud[i].getVector3fMap ()).norm (), 1e-5f);
      as_given += points[i].normal.dot (cloud[i].getNormalVector3fMap ()) > 0.7f;
    }
    EXPECT_GT (as_given, 0.98 * static_cast<double> (points.size ()));
  }
}

/** \brief From the origin of a frame on the floor the table is seen from below: few of its points are hidden, but all
 * of the ball. */
TEST_F (UnorganizedView, FromBelowATableNothingWasSeen)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  const auto add = [&cloud] (const Eigen::Vector3f& p, std::uint32_t label) {
    cloud.emplace_back ();
    cloud.back ().getVector3fMap () = p;
    cloud.back ().label = label;
  };
  const Eigen::Vector3f eye = middle + Eigen::Vector3f (0.0f, -0.6f, 0.6f);
  for (const auto& p : ball (2000, false))
    if (p.getNormalVector3fMap ().dot (eye - p.getVector3fMap ()) > 0.02f)
      add (p.getVector3fMap (), 1);
  for (int i = -60; i <= 60; ++i)
    for (int j = -60; j <= 60; ++j)
      add (middle + Eigen::Vector3f (0.006f * i, 0.006f * j, -radius_m), 0);
  const LabelledView view = read (cloud);
  EXPECT_FALSE (view.view);
  EXPECT_TRUE (mentions (view, "is not known"));
  EXPECT_GT (outward (view), 0.99);
  for (const OrientedPoint& p : view.objects.at (0).points)
    ASSERT_GT (p.normal.z (), 0.9f);
}

TEST_F (UnorganizedView, NormalsThatNobodyFilledAreEstimated)
{
  for (const float value : {0.0f, std::numeric_limits<float>::quiet_NaN ()})
  {
    auto cloud = ball (4000, true);
    for (auto& p : cloud)
      p.getNormalVector3fMap ().setConstant (value);
    EXPECT_GT (outward (read (cloud)), 0.99);
  }
}

/** \brief A few remaining points of a table that was cut away do not determine signs. */
TEST_F (UnorganizedView, AFewPointsOfTheBackgroundTurnNothing)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  for (const auto& p : ball (3000, false))
    if (p.normal_z > -0.3f)
    {
      cloud.emplace_back ();
      cloud.back ().getVector3fMap () = p.getVector3fMap () - middle;
      cloud.back ().label = 1;
    }
  for (int i = 0; i < 60; ++i) // above it
  {
    cloud.emplace_back ();
    cloud.back ().getVector3fMap () = Eigen::Vector3f (0.004f * static_cast<float> (i % 8),
                                                       0.004f * static_cast<float> (i / 8), radius_m + 0.02f);
  }
  const LabelledView view = read (cloud);
  EXPECT_GT (outward (view, 0.7, Eigen::Vector3f::Zero ()), 0.99);
}

TEST_F (UnorganizedView, FlippedNormalsAreTurned)
{
  auto cloud = ball (4000, false);
  for (auto& p : cloud)
    p.getNormalVector3fMap () *= -1.0f;
  const LabelledView view = read (cloud);
  EXPECT_TRUE (mentions (view, "point inward; they were turned"));
  EXPECT_EQ (outward (view), 1.0);
}

TEST_F (UnorganizedView, NormalsAwayFromTheViewpointAreTurned)
{
  auto cloud = ball (4000, true);
  for (std::size_t i = 0; i < cloud.size (); i += 4)
    cloud[i].getNormalVector3fMap () *= -1.0f;
  const LabelledView view = read (cloud);
  ASSERT_TRUE (view.view);
  EXPECT_TRUE (mentions (view, "point away from the VIEWPOINT"));
  EXPECT_GT (outward (view), 0.95); // a few at the rim are not clearly away
}

/** \brief Also normals at grazing angles, each of which alone could be noise. */
TEST_F (UnorganizedView, AllNormalsAreTurnedIfMostPointAway)
{
  auto cloud = ball (4000, true);
  for (auto& p : cloud)
    p.getNormalVector3fMap () *= -1.0f;
  const LabelledView view = read (cloud);
  ASSERT_TRUE (view.view);
  EXPECT_TRUE (mentions (view, "point away from the VIEWPOINT"));
  EXPECT_EQ (outward (view), 1.0);
}

TEST_F (UnorganizedView, GoodNormalsAreLeftAlone)
{
  for (const bool near_side_only : {true, false})
  {
    const auto cloud = ball (3000, near_side_only);
    const LabelledView view = read (cloud);
    EXPECT_TRUE (view.warnings.empty ()) << view.warnings[0];
    ASSERT_EQ (view.objects.at (1).points.size (), cloud.size ());
    for (std::size_t i = 0; i < cloud.size (); ++i)
      ASSERT_GT (view.objects.at (1).points[i].normal.dot (cloud[i].getNormalVector3fMap ()), 0.999f);
  }
}

TEST_F (UnorganizedView, TheBackgroundFacesTheObjects)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  for (const auto& p : ball (3000, false))
  {
    cloud.emplace_back ();
    cloud.back ().getVector3fMap () = p.getVector3fMap ();
    cloud.back ().label = 1;
  }
  for (int i = -30; i <= 30; ++i)
    for (int j = -30; j <= 30; ++j)
    {
      cloud.emplace_back ();
      cloud.back ().getVector3fMap () = middle + Eigen::Vector3f (0.01f * i, 0.01f * j, -radius_m);
    }
  const LabelledView view = read (cloud);
  EXPECT_GT (outward (view), 0.99);
  for (const OrientedPoint& p : view.objects.at (0).points)
    ASSERT_GT (p.normal.z (), 0.9f);
}

/** \brief The inside of a bowl on a table, in random order, with a room's walls and mixed pixels. */
TEST_F (UnorganizedView, WhatWasSeenOfObjectsFacesAwayFromTheirSupport)
{
  std::mt19937 random (7);
  std::uniform_real_distribution<float> uniform (-1.0f, 1.0f);
  pcl::PointCloud<pcl::PointXYZL> cloud;
  const auto add = [&cloud] (const Eigen::Vector3f& p, std::uint32_t label) {
    cloud.emplace_back ();
    cloud.back ().getVector3fMap () = p;
    cloud.back ().label = label;
  };
  const Eigen::Vector3f center = middle -
                                 Eigen::Vector3f (0.0f, 0.0f,
                                                  middle.z ()); // of the bowl, at the height of the frame's origin
  for (const auto& p : ball (8000, false))
    if (p.normal_z < -0.1f)
      add (p.getVector3fMap () - middle + center, 1);
  const float table = center.z () - radius_m - 0.01f;
  for (int i = -60; i <= 60; ++i)
    for (int j = -60; j <= 60; ++j)
      add (center + Eigen::Vector3f (0.006f * i, 0.006f * j, table - center.z ()), 0);
  for (int i = 0; i < 40; ++i)
    add (center +
             Eigen::Vector3f (0.15f * uniform (random), 0.15f * uniform (random), 0.05f + 0.05f * uniform (random)),
         0);
  for (int i = 0; i < 60000; ++i) // a wall, farther away than the size of everything else
    add (Eigen::Vector3f (-4.0f, 3.0f * uniform (random), 3.0f * uniform (random)), 0);
  std::shuffle (cloud.begin (), cloud.end (), random);
  const LabelledView view = read (cloud);
  EXPECT_FALSE (view.view);
  double inward = 0.0;
  for (const OrientedPoint& p : view.objects.at (1).points)
    inward += p.normal.dot ((p.position - center).normalized ()) < -0.7f;
  EXPECT_GT (inward, 0.98 * static_cast<double> (view.objects.at (1).points.size ()));
  int floating = 0;
  for (const OrientedPoint& p : view.objects.at (0).points)
  {
    if (p.position.x () < -3.0f)
      continue;
    floating += p.position.z () > table + 0.01f;
    if (p.position.z () < table + 0.01f)
    {
      ASSERT_GT (p.normal.z (), 0.9f);
    }
  }
  EXPECT_EQ (floating, 0);
}

/** \brief The nearest neighbours alone would show noise. */
TEST_F (UnorganizedView, DenseAndNoisyCloudsGetGoodNormals)
{
  const LabelledView view = read (withoutNormals (ball (300000, true, 0.001f)));
  EXPECT_EQ (view.objects.at (1).points.size (), 300000u);
  EXPECT_GT (outward (view, 0.7), 0.95);
}

TEST_F (UnorganizedView, IntensityIsRead)
{
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (const auto& p : ball (500, true))
  {
    cloud.emplace_back (static_cast<float> (cloud.size ()));
    cloud.back ().getVector3fMap () = p.getVector3fMap ();
  }
  cloud[7].intensity = std::numeric_limits<float>::infinity ();
  const LabelledView view = read (cloud);
  EXPECT_TRUE (view.has_intensity);
  EXPECT_EQ (view.objects.at (1).points[100].intensity, 100.0f);
  EXPECT_TRUE (std::isnan (view.objects.at (1).points[7].intensity)); // like a missing reading
}

TEST_F (UnorganizedView, MemoryIsLimited)
{
  PcdViewOptions options;
  options.max_memory_bytes = 100000;
  const std::string path = save (ball (4000, true));
  const std::string message = messageOf<MemoryLimitExceeded> ([&] { readPcdView (path, options); });
  EXPECT_NE (message.find ("4000 points"), std::string::npos) << message;
  options.max_memory_bytes = 10000000;
  EXPECT_EQ (readPcdView (path, options).objects.at (1).readings, 4000u);
}

TEST_F (UnorganizedView, LabelsThatNumberNoObjectsAreRefused)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  for (std::uint32_t label = 1; label <= 10001; ++label)
    for (int i = 0; i < 100; ++i)
      cloud.emplace_back (0.01f * static_cast<float> (i), 0.01f * static_cast<float> (label), 1.0f, label);
  const std::string message = messageOf<DegenerateInput> ([&] { read (cloud); });
  EXPECT_NE (message.find ("10001 labels"), std::string::npos) << message;
}
