// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Places from which a cloud was not seen: its background shows through its objects.

#include "io/pcd_view_fixture.h"

#include "pcl_cosection/view/range_image.h"

#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector3f seen_from (0.0f, -1.0f, 0.7f);
const Eigen::Vector3d other_side (0.0, 1.0, 0.7);

/** \brief A ball on a table, as a sensor at seen_from sees both, in a random order. */
pcl::PointCloud<pcl::PointXYZL>
ballOnATable ()
{
  constexpr float radius_m = 0.08f;
  const Eigen::Vector3f center (0.0f, 0.0f, radius_m);
  std::mt19937 random (4);
  std::uniform_real_distribution<float> uniform (-0.5f, 0.5f);
  std::normal_distribution<float> gauss;
  pcl::PointCloud<pcl::PointXYZL> cloud;
  const auto add = [&] (const Eigen::Vector3f& p, std::uint32_t label) {
    pcl::PointXYZL point;
    point.getVector3fMap () = p;
    point.label = label;
    cloud.push_back (point);
  };
  while (cloud.size () < 4000)
  {
    const Eigen::Vector3f n = Eigen::Vector3f (gauss (random), gauss (random), gauss (random)).normalized ();
    if (n.dot (seen_from - center - radius_m * n) > 0.0f)
      add (center + radius_m * n, 1);
  }
  while (cloud.size () < 40000)
  {
    const Eigen::Vector3f p (uniform (random), uniform (random), 0.0f), ray = (p - seen_from).normalized ();
    if ((center - seen_from).cross (ray).norm () > radius_m) // not in the shadow of the ball
      add (p, 0);
  }
  std::shuffle (cloud.begin (), cloud.end (), random);
  return cloud;
}

} // namespace

using SeenThrough = PcdView;

TEST_F (SeenThrough, NothingIsFromWhereTheSensorStood)
{
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> labels;
  for (const pcl::PointXYZL& p : ballOnATable ())
  {
    points.emplace_back (p.getVector3fMap ());
    labels.push_back (p.label);
  }
  const auto right = drawRangeImage (points, seen_from.cast<double> ()), wrong = drawRangeImage (points, other_side);
  ASSERT_TRUE (right && wrong);
  EXPECT_LT (right->seenThrough (points, labels), 0.05);
  EXPECT_GT (wrong->seenThrough (points, labels), 0.8);
  EXPECT_LT (wrong->hidden_share, RangeImage::max_hidden_share) << "which alone says nothing";
  EXPECT_EQ (wrong->seenThrough (points, std::vector<std::uint32_t> (points.size (), 1)), 0.0) << "all is one thing";
}

TEST_F (SeenThrough, AViewpointOnTheOtherSideIsNotUsed)
{
  pcl::io::savePCDFileBinary (path ("ball.pcd"), ballOnATable ());
  for (const bool is_right : {true, false})
  {
    PcdViewOptions options;
    options.viewpoint = {0.0, is_right ? -1.0 : 1.0, 0.7};
    const LabelledView view = readPcdView (path ("ball.pcd"), options);
    EXPECT_EQ (view.view.has_value (), is_right);
    EXPECT_EQ (std::count_if (view.warnings.begin (), view.warnings.end (),
                              [] (const std::string& warning) {
                                return warning.find ("not seen from --viewpoint") != std::string::npos;
                              }),
               is_right ? 0 : 1);
  }
}

/** \brief In another frame, points may lie before its origin as before a camera, and behind the table by chance. */
TEST_F (SeenThrough, AnOriginBelowTheTableIsNoCamera)
{
  for (const Eigen::Vector3f& offset : {Eigen::Vector3f (0.3f, 2.0f, 5.0f), Eigen::Vector3f (2.0f, 3.0f, 60.0f)})
  {
    SCOPED_TRACE (offset.transpose ());
    pcl::PointCloud<pcl::PointXYZL> cloud = ballOnATable ();
    for (pcl::PointXYZL& point : cloud)
      point.getVector3fMap () += offset;
    pcl::io::savePCDFileBinary (path ("ball.pcd"), cloud);
    const LabelledView view = readPcdView (path ("ball.pcd"));
    EXPECT_FALSE (view.view);
    ASSERT_EQ (view.warnings.size (), 1u);
    EXPECT_NE (view.warnings[0].find ("where its points were seen from is not known"), std::string::npos);
    const Eigen::Vector3f center = offset + Eigen::Vector3f (0.0f, 0.0f, 0.08f);
    for (const OrientedPoint& point : view.objects.at (1).points)
      ASSERT_GT (point.normal.dot ((point.position - center).normalized ()), 0.0f);
  }
}
