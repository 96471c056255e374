// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Objects in points without an order.

#include "pcl_cosection/segmentation/clusters/cloud_segmentation.h"
#include "pcl_cosection/segmentation/clusters/cluster_segmentation.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/view/range_image.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>

using namespace pcl::cosection;

namespace {

/** \brief Points in a random order, with what they are of. */
struct LabelledPoints
{
  std::vector<Eigen::Vector3f> points;
  std::vector<int> of;

  /** \brief The surface of a box without its lower side, a point every 5 mm with some noise. */
  void addBox (const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, int number)
  {
    std::mt19937 random (number);
    std::normal_distribution<float> noise (0.0f, 0.0008f);
    constexpr float step = 0.005f;
    for (float x = lower.x (); x <= upper.x (); x += step)
      for (float y = lower.y (); y <= upper.y (); y += step)
        for (float z = lower.z (); z <= upper.z () + 0.5f * step; z += step)
        {
          const bool is_side = x == lower.x () || y == lower.y () || x + step > upper.x () || y + step > upper.y ();
          if (is_side || z + step > upper.z () + 0.5f * step)
          {
            points.emplace_back (x + noise (random), y + noise (random), z + noise (random));
            of.push_back (number);
          }
        }
  }

  /** \brief Mix them, and take them to another frame. */
  void scatter (const Eigen::Isometry3f& T)
  {
    std::vector<std::size_t> order (points.size ());
    for (std::size_t n = 0; n < order.size (); ++n)
      order[n] = n;
    std::shuffle (order.begin (), order.end (), std::mt19937 (9));
    LabelledPoints mixed;
    for (const std::size_t n : order)
    {
      mixed.points.push_back (T * points[n]);
      mixed.of.push_back (of[n]);
    }
    *this = mixed;
  }
};

LabelledPoints
tableWithThreeThings ()
{
  LabelledPoints scene;
  scene.addBox ({-0.6f, -0.4f, 0.0f}, {0.6f, 0.4f, 0.0f}, 0);
  scene.addBox ({-0.3f, -0.1f, 0.01f}, {-0.15f, 0.05f, 0.2f}, 1);
  scene.addBox ({0.0f, 0.1f, 0.01f}, {0.1f, 0.2f, 0.1f}, 2);
  scene.addBox ({0.2f, -0.2f, 0.01f}, {0.26f, -0.14f, 0.06f}, 3);
  return scene;
}

Eigen::Isometry3f
somewhere ()
{
  Eigen::Isometry3f T (Eigen::AngleAxisf (2.0f, Eigen::Vector3f (1.0f, 2.0f, -1.0f).normalized ()));
  T.pretranslate (Eigen::Vector3f (0.3f, -2.0f, 1.0f));
  return T;
}

/** \brief Share of the points of one thing that have a label. */
double
shareOf (const LabelledPoints& scene, const ObjectSegmentation& found, int thing, std::uint32_t label)
{
  double same = 0.0, all = 0.0;
  for (std::size_t n = 0; n < scene.points.size (); ++n)
    if (scene.of[n] == thing)
    {
      ++all;
      same += found.labels[n] == label;
    }
  return same / all;
}

} // namespace

TEST (ClusterSegmentation, FindsWhatStandsOnATable)
{
  LabelledPoints scene = tableWithThreeThings ();
  scene.scatter (somewhere ());
  scene.points.emplace_back (Eigen::Vector3f::Constant (std::nanf ("")));
  scene.of.push_back (0);
  const ObjectSegmentation found = segmentClusters (scene.points);
  EXPECT_EQ (found.objects, 3u);
  ASSERT_EQ (found.support_planes.size (), 1u);
  EXPECT_GT (shareOf (scene, found, 0, 0), 0.999);
  for (int thing = 1; thing <= 3; ++thing)
    EXPECT_GT (shareOf (scene, found, thing, static_cast<std::uint32_t> (thing)), 0.9) << "the largest is the first";
  const Eigen::Vector3f up = somewhere ().linear ().col (2);
  EXPECT_GT (found.support_planes[0].head<3> ().dot (up), 0.999f) << "to the side of the objects";
}

TEST (CloudSegmentation, ThingsThatTouchAreTwoIfTheirSensorIsKnown)
{
  LabelledPoints scene;
  scene.addBox ({-0.4f, -0.3f, 0.0f}, {0.4f, 0.3f, 0.0f}, 0);
  scene.addBox ({-0.12f, -0.05f, 0.0f}, {0.0f, 0.1f, 0.15f}, 1);
  scene.addBox ({0.0f, -0.1f, 0.0f}, {0.12f, 0.05f, 0.06f}, 2);
  const Eigen::Isometry3f T_sensor_scene = lookAt ({0.3, -0.7, 0.6}, {0.0, 0.0, 0.05}).inverse ().cast<float> ();
  scene.scatter (T_sensor_scene);
  const std::optional<RangeImage> image = drawRangeImage (scene.points, Eigen::Vector3d::Zero ());
  ASSERT_TRUE (image);
  OrganizedCloud cloud;
  LabelledPoints seen;
  for (std::size_t n = 0; n < scene.points.size (); ++n)
    if (!image->hides (scene.points[n]))
    {
      seen.points.push_back (scene.points[n]);
      seen.of.push_back (scene.of[n]);
    }
  cloud.points = seen.points;
  cloud.points.emplace_back (Eigen::Vector3f::Constant (std::nanf ("")));
  cloud.width = static_cast<int> (cloud.points.size ());
  cloud.height = 1;
  EXPECT_EQ (segmentCloud (cloud, {}).objects, 1u);
  cloud.seen_from_origin = true;
  const ObjectSegmentation found = segmentCloud (cloud, {});
  ASSERT_EQ (found.objects, 2u);
  ASSERT_EQ (found.labels.size (), cloud.points.size ());
  EXPECT_GT (shareOf (seen, found, 0, 0), 0.98);
  for (int thing = 1; thing <= 2; ++thing)
    EXPECT_GT (std::max (shareOf (seen, found, thing, 1), shareOf (seen, found, thing, 2)), 0.9);
  ASSERT_EQ (found.support_planes.size (), 1u);
  const Eigen::Vector3f up = T_sensor_scene.linear ().col (2);
  EXPECT_GT (found.support_planes[0].head<3> ().dot (up), 0.99f);
}

/** \brief Shiny patches of a table, as far ground, read above and below it: what is above is no object. */
TEST (ClusterSegmentation, NoiseOfAPlaneIsNoObject)
{
  LabelledPoints scene = tableWithThreeThings ();
  std::mt19937 random (5);
  std::uniform_real_distribution<float> across (-0.04f, 0.04f);
  std::normal_distribution<float> noise (0.0f, 0.012f);
  for (const float x : {-0.45f, -0.05f, 0.4f})
    for (int n = 0; n < 1000; ++n)
      scene.points.emplace_back (x + across (random), -0.25f + across (random), noise (random));
  scene.of.resize (scene.points.size (), 0);
  scene.scatter (somewhere ());
  const ObjectSegmentation found = segmentClusters (scene.points);
  std::map<std::uint32_t, int> counts;
  for (const std::uint32_t label : found.labels)
    ++counts[label];
  counts.erase (0);
  EXPECT_EQ (std::count_if (counts.begin (), counts.end (), [] (const auto& label) { return label.second >= 100; }), 3);
}

/** \brief Of a ball that was seen from above, the lower part is hidden from all sides. */
TEST (ClusterSegmentation, WhatHidesItsFootStandsOnItsPlane)
{
  LabelledPoints scene = tableWithThreeThings ();
  const Eigen::Vector3f center (-0.3f, 0.25f, 0.06f);
  std::mt19937 random (6);
  std::normal_distribution<float> gauss;
  for (int n = 0; n < 4000;)
    if (const Eigen::Vector3f d = Eigen::Vector3f (gauss (random), gauss (random), gauss (random)).normalized ();
        d.z () > -0.5f)
    {
      scene.points.push_back (center + 0.06f * d);
      scene.of.push_back (4);
      ++n;
    }
  scene.scatter (somewhere ());
  EXPECT_EQ (segmentClusters (scene.points).objects, 4u);
}

TEST (ClusterSegmentation, LongThingsAndCrumbsAreNoObjects)
{
  LabelledPoints scene = tableWithThreeThings ();
  ObjectSegmentationOptions options;
  ObjectSegmentation found = segmentClusters (scene.points, options);
  EXPECT_EQ (found.objects, 3u);
  EXPECT_TRUE (warningsOf (found, options).empty ());
  options.max_object_size_m = 0.15;
  found = segmentClusters (scene.points, options);
  EXPECT_EQ (found.objects, 2u);
  const std::vector<std::string> warnings = warningsOf (found, options);
  ASSERT_EQ (warnings.size (), 1u);
  EXPECT_NE (warnings[0].find ("of what is longer than 0.15 m"), std::string::npos) << warnings[0];
  options.min_object_size_m = 0.08;
  EXPECT_EQ (segmentClusters (scene.points, options).objects, 1u);
}

TEST (ClusterSegmentation, WithoutAPlaneEachGroupIsOne)
{
  LabelledPoints scene;
  scene.addBox ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f}, 1);
  scene.addBox ({0.3f, 0.0f, 0.0f}, {0.35f, 0.05f, 0.05f}, 2);
  const ObjectSegmentation found = segmentClusters (scene.points);
  EXPECT_EQ (found.objects, 2u);
  EXPECT_TRUE (found.support_planes.empty ());
}

TEST (ClusterSegmentation, RefusesWhatHasNoPoints)
{
  EXPECT_THROW (segmentClusters ({}), DegenerateInput);
  EXPECT_THROW (segmentClusters (std::vector<Eigen::Vector3f> (200, Eigen::Vector3f::Constant (std::nanf ("")))),
                DegenerateInput);
  EXPECT_EQ (segmentClusters (std::vector<Eigen::Vector3f> (200, Eigen::Vector3f::Ones ())).objects, 0u);
}
