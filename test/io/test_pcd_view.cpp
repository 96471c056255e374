// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "common/replaced.h"
#include "pcd_view_fixture.h"

#include <pcl/cosection/common/error.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Points on a sphere's lower half at (0, 0, 2), as a sensor at the origin sees it. */
pcl::PointCloud<pcl::PointXYZ>
hemisphere (int count)
{
  std::mt19937 generator (5);
  std::normal_distribution<float> gauss;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < count; ++i)
  {
    Eigen::Vector3f n (gauss (generator), gauss (generator), gauss (generator));
    n.normalize ();
    n.z () = -std::abs (n.z ());
    if (n.z () > -0.3f) // the sensor does not see the rim
      continue;
    const Eigen::Vector3f p = Eigen::Vector3f (0.0f, 0.0f, 2.0f) + 0.3f * n;
    cloud.emplace_back (p.x (), p.y (), p.z ());
  }
  return (cloud);
}

} // namespace

TEST_F (PcdView, OrganizedGivesRaysNormalsLabelsAndColours)
{
  auto cloud = organizedPlane ();
  cloud.at (5, 6).x = not_a_number;
  cloud.sensor_origin_ = Eigen::Vector4f (1.0f, 2.0f, 3.0f, 0.0f);
  cloud.sensor_orientation_ = Eigen::Quaternionf (Eigen::AngleAxisf (0.5f, Eigen::Vector3f::UnitX ()));
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  pcl::io::savePCDFileBinaryCompressed (path ("b.pcd"), cloud);
  pcl::io::savePCDFileASCII (path ("c.pcd"), cloud);
  const Eigen::Isometry3d T = Eigen::Translation3d (1, 2, 3) * Eigen::AngleAxisd (0.5, Eigen::Vector3d::UnitX ());
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"})
  {
    SCOPED_TRACE (name);
    const LabelledView view = readPcdView (path (name));
    EXPECT_TRUE (view.warnings.empty ());
    EXPECT_TRUE (view.has_labels);
    EXPECT_TRUE (view.has_colour);
    ASSERT_EQ (view.objects.size (), 2u);
    EXPECT_EQ (view.objects.at (0).readings, 32u * 48u - 1u);
    EXPECT_EQ (view.objects.at (7).readings, 32u * 48u);
    ASSERT_GT (view.objects.at (7).points.size (), 1400u);
    for (const OrientedPoint& p : view.objects.at (7).points)
    {
      EXPECT_NEAR ((T.inverse () * p.position.cast<double> ()).z (), 1.0, 1e-5);
      EXPECT_LT ((p.normal.cast<double> () + T.linear ().col (2)).norm (), 1e-3);
      EXPECT_EQ (p.colour, (std::array<std::uint8_t, 3>{10, 20, 30}));
      EXPECT_EQ (p.weight, 1.0f);
    }
    ASSERT_TRUE (view.view);
    EXPECT_NEAR (view.view->camera.fx, 60.0, 1e-3);
    EXPECT_NEAR (view.view->camera.cy, 24.0, 1e-3);
    EXPECT_TRUE (view.view->T_world_sensor.isApprox (T, 1e-6));
    EXPECT_NEAR (view.view->at (40, 40), 1.0f, 1e-5f);
    EXPECT_TRUE (std::isnan (view.view->at (5, 6)));
  }
}

TEST_F (PcdView, ManyMissingReadingsLeaveNormals)
{
  auto cloud = organizedPlane ();
  std::mt19937 generator (2);
  for (auto& p : cloud)
    if (generator () % 4 != 0)
      p.x = p.y = p.z = not_a_number;
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  const LabelledView view = readPcdView (path ("a.pcd"));
  EXPECT_TRUE (view.view);
  for (const std::uint32_t label : {0u, 7u})
  {
    const LabelledView::Points& object = view.objects.at (label);
    EXPECT_GT (object.points.size (), object.readings * 9 / 10);
    for (const OrientedPoint& p : object.points)
      EXPECT_LT ((p.normal + Eigen::Vector3f::UnitZ ()).norm (), 1e-2f);
  }
}

TEST_F (PcdView, ScaleTurnsMillimetresIntoMetres)
{
  auto cloud = organizedPlane ();
  for (auto& p : cloud)
    p.getVector3fMap () *= 1000.0f;
  cloud.sensor_origin_ = Eigen::Vector4f (500.0f, 0.0f, 0.0f, 0.0f);
  pcl::io::savePCDFileBinary (path ("mm.pcd"), cloud);
  const LabelledView unscaled = readPcdView (path ("mm.pcd"));
  ASSERT_FALSE (unscaled.warnings.empty ());
  EXPECT_NE (unscaled.warnings[0].find ("--scale 0.001"), std::string::npos);
  PcdViewOptions options;
  options.scale = 0.001;
  const LabelledView view = readPcdView (path ("mm.pcd"), options);
  EXPECT_TRUE (view.warnings.empty ());
  EXPECT_NEAR (view.view->at (3, 3), 1.0f, 1e-5f);
  EXPECT_NEAR (view.view->T_world_sensor.translation ().x (), 0.5, 1e-6);
}

TEST_F (PcdView, WithoutAPinholePointsHaveNoOrderUnlessIntrinsicsAreGiven)
{
  auto cloud = organizedPlane ();
  std::mt19937 generator (1);
  std::uniform_real_distribution<float> jitter (-0.05f, 0.05f); // three pixels
  for (auto& p : cloud)
    p.x += jitter (generator);
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  LabelledView view = readPcdView (path ("a.pcd"));
  ASSERT_FALSE (view.warnings.empty ());
  EXPECT_NE (view.warnings[0].find ("--intrinsics"), std::string::npos);
  auto list = cloud;
  list.width *= list.height;
  list.height = 1;
  pcl::io::savePCDFileBinary (path ("list.pcd"), list);
  const LabelledView listed = readPcdView (path ("list.pcd"));
  EXPECT_EQ (view.warnings.size (), listed.warnings.size () + 1);
  ASSERT_EQ (view.view.has_value (), listed.view.has_value ());
  ASSERT_TRUE (listed.view);
  EXPECT_EQ (view.view->camera.fx, listed.view->camera.fx);
  ASSERT_EQ (view.objects.at (7).points.size (), listed.objects.at (7).points.size ());
  for (std::size_t i = 0; i < listed.objects.at (7).points.size (); ++i)
    EXPECT_EQ (view.objects.at (7).points[i].normal, listed.objects.at (7).points[i].normal);
  PcdViewOptions options;
  options.intrinsics = {60.0, 62.0, 31.0, 24.0};
  view = readPcdView (path ("a.pcd"), options);
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.view->camera.fy, 62.0);
  EXPECT_TRUE (view.warnings.empty ());
  options.intrinsics = {30.0, 30.0, 31.0, 24.0};
  view = readPcdView (path ("a.pcd"), options);
  ASSERT_EQ (view.warnings.size (), 1u);
  EXPECT_NE (view.warnings[0].find ("off the given intrinsics"), std::string::npos);
}

TEST_F (PcdView, ZeroIsNoReadingInAnOrganizedCloud)
{
  auto cloud = organizedPlane ();
  cloud.at (40, 10).getVector3fMap ().setZero ();
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  const LabelledView view = readPcdView (path ("a.pcd"));
  EXPECT_EQ (view.objects.at (7).readings, 32u * 48u - 1u);
  EXPECT_TRUE (std::isnan (view.view->at (40, 10)));
}

TEST_F (PcdView, UnorganizedGetsNormalsTowardsTheSensor)
{
  pcl::io::savePCDFileBinary (path ("a.pcd"), hemisphere (3000));
  const LabelledView view = readPcdView (path ("a.pcd"));
  EXPECT_TRUE (view.view);
  EXPECT_FALSE (view.has_labels);
  EXPECT_FALSE (view.has_colour);
  EXPECT_TRUE (view.warnings.empty ());
  ASSERT_EQ (view.objects.size (), 1u);
  int good = 0;
  for (const OrientedPoint& p : view.objects.at (1).points)
    good += p.normal.dot ((p.position - Eigen::Vector3f (0, 0, 2)).normalized ()) > 0.9f;
  EXPECT_GT (good, 0.98 * static_cast<double> (view.objects.at (1).points.size ()));
}

TEST_F (PcdView, SensorAmongThePointsIsWarnedOf)
{
  auto cloud = hemisphere (500);
  for (auto& p : cloud)
    p.z -= 1.8f;
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  const LabelledView view = readPcdView (path ("a.pcd"));
  ASSERT_EQ (view.warnings.size (), 1u);
  EXPECT_NE (view.warnings[0].find ("VIEWPOINT"), std::string::npos);
}

TEST_F (PcdView, NormalsOfTheFileAreKept)
{
  const std::string file = write (
      header (3, 1, "ascii", "x y z normal_x normal_y normal_z", "4 4 4 4 4 4", "F F F F F F", "0 0 5 0 1 0 0") +
      "1 2 3 0 0 2\n4 5 6 nan nan nan\n7 8 9 0 0 0\n");
  const LabelledView view = readPcdView (file);
  EXPECT_EQ (view.objects.at (1).readings, 3u);
  ASSERT_EQ (view.objects.at (1).points.size (), 1u); // a point with a zero normal has no normal
  EXPECT_TRUE (view.objects.at (1).points[0].normal.isApprox (-Eigen::Vector3f::UnitZ (), 1e-6f));
  EXPECT_TRUE (view.objects.at (1).points[0].position.isApprox (Eigen::Vector3f (1, -2, 2), 1e-6f));
}

TEST_F (PcdView, CoordinatesMayBeIntegers)
{
  PcdViewOptions options;
  options.scale = 0.001;
  for (const std::string size : {"2 4 8", "2 2 2", "8 8 8"})
  {
    const LabelledView view = readPcdView (
        write (header (2, 1, "ascii", "x y z normal_x normal_y normal_z", size + " 1 1 1", "I I I I I I") +
               "-100 200 1500 0 0 -1\n0 0 0 0 0 -1\n"),
        options);
    EXPECT_EQ (view.objects.at (1).readings, 1u); // (0, 0, 0) is no reading
    ASSERT_EQ (view.objects.at (1).points.size (), 1u);
    EXPECT_TRUE (view.objects.at (1).points[0].position.isApprox (Eigen::Vector3f (-0.1f, 0.2f, 1.5f), 1e-6f));
  }
}

TEST_F (PcdView, NormalsMayHaveAnyLength)
{
  for (const char* normal : {"0.6 0 -0.8", "0.0006 0 -0.0008", "6e-7 0 -8e-7", "6e15 0 -8e15", "6e-39 0 -8e-39"})
  {
    SCOPED_TRACE (normal);
    const LabelledView view = readPcdView (write (
        header (1, 1, "ascii", "x y z normal_x normal_y normal_z", "4 4 4 4 4 4", "F F F F F F") + "1 2 3 " + normal));
    ASSERT_EQ (view.objects.at (1).points.size (), 1u);
    EXPECT_TRUE (view.objects.at (1).points[0].normal.isApprox (Eigen::Vector3f (0.6f, 0.0f, -0.8f), 1e-5f));
  }
}

TEST_F (PcdView, HeadersAsOtherProgramsWriteThem)
{
  const std::string usual = header (2, 1, "ascii", "x y z label", "4 4 4 4", "F F F U") + "1 2 3 7\n4 5 6 7\n";
  std::string other_lines;
  for (const char c : usual)
    other_lines += c == '\n' ? "\r\n" : std::string (1, c);
  const std::size_t points = usual.find ("POINTS"), data = usual.find ("DATA");
  for (const std::string& text :
       {usual, "\xef\xbb\xbf" + usual, other_lines, usual.substr (0, points) + usual.substr (data)})
    EXPECT_EQ (readPcdView (write (text)).objects.count (7), 1u) << text;
  std::string many = replaced (header (7, 1, "binary"), "WIDTH 7\nHEIGHT 1", "WIDTH 2147483647\nHEIGHT 2147483647");
  many.erase (many.find ("POINTS"), many.find ("DATA") - many.find ("POINTS"));
  EXPECT_NE (failure<IoError> (write (many)).find ("WIDTH times HEIGHT"), std::string::npos);
}

TEST_F (PcdView, BadFilesAreRefusedInOneLine)
{
  EXPECT_NE (failure<IoError> (path ("missing.pcd")).find ("no such file"), std::string::npos);
  EXPECT_NE (failure<IoError> (path ("")).find ("directory"), std::string::npos);
  EXPECT_NE (failure<IoError> (write ("")).find ("empty"), std::string::npos);
  EXPECT_NE (failure<IoError> (write ("ply\nformat ascii 1.0\n")).find ("header does not end"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (std::string (100000, '\x7f'))).find ("neither a PCD"), std::string::npos);
  EXPECT_NE (failure<IoError> (write ("# .PCD\nVERSION 0.7\n")).find ("no DATA"), std::string::npos);
  EXPECT_NE (failure<DegenerateInput> (write (header (0, 1))).find ("no points"), std::string::npos);
  EXPECT_NE (failure<DegenerateInput> (write (header (2, 1) + "nan nan nan\nnan nan nan\n")).find ("finite"),
             std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (1, 1, "ascii", "x y w") + "1 2 3\n")).find ("no field z"),
             std::string::npos);
  const std::string twice = replaced (header (1, 1), "COUNT 1 1 1", "COUNT 1 1 2") + "1 2 3 4\n";
  EXPECT_NE (failure<IoError> (write (twice)).find ("field z must be one number"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (1, 1, "ascii", "x y z label", "4 4 4 4", "F F F F") + "1 2 3 4.5\n"))
                 .find ("label 4.5, which is not an integer"),
             std::string::npos);
  for (const char* large : {"4e9", "inf", "1e300"})
    EXPECT_NE (
        failure<IoError> (write (header (1, 1, "ascii", "x y z label", "4 4 4 8", "F F F F") + "1 2 3 " + large + "\n"))
            .find ("too large"),
        std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (1, 1, "ascii", "x y z", "4 4 3") + "1 2 3\n")).find ("SIZE"),
             std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (1, 1, "gzip") + "1 2 3\n")).find ("ascii, binary"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (1, 1, "ascii", "x y z", "4 4 4", "F F F", "0 0 0 0 0 0 0") + "1 2 3\n"))
                 .find ("VIEWPOINT"),
             std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (2, 1) + "1 2 3\n1 2 x\n")).find ("not a number"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (2, 1) + "1 2 3\n1 2 3 4\n")).find ("4 values"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (3, 1) + "1 2 3 \n1 2 3     \n")).find ("truncated"), std::string::npos);
  EXPECT_NE (failure<IoError> (write (header (40000, 40000, "binary") + "abc")).find ("truncated"), std::string::npos);
  for (const char* absurd : {"WIDTH 99999999999999999999", "WIDTH -7"})
    EXPECT_NE (failure<IoError> (write (replaced (header (7, 1, "binary"), "WIDTH 7", absurd))).find ("WIDTH"),
               std::string::npos);
}

TEST_F (PcdView, DamagedFilesNeverCrash)
{
  auto cloud = organizedPlane ();
  pcl::io::savePCDFileBinary (path ("binary.pcd"), cloud);
  pcl::io::savePCDFileBinaryCompressed (path ("compressed.pcd"), cloud);
  cloud.resize (50);
  pcl::io::savePCDFileASCII (path ("ascii.pcd"), cloud);
  std::mt19937 generator (7);
  int refused = 0;
  for (const char* name : {"binary.pcd", "compressed.pcd", "ascii.pcd"})
  {
    const std::string good = readFile (path (name));
    for (int trial = 0; trial < 60; ++trial)
    {
      std::string bad = good;
      if (trial % 3 == 0)
        bad.resize (generator () % good.size ());
      else
        for (int k = 0; k < 3; ++k) // in the header, or right after it
          bad[generator () % std::min<std::size_t> (bad.size (), trial % 3 == 1 ? 180 : 400)] = static_cast<char> (
              generator ());
      try
      {
        readPcdView (write (bad));
      }
      catch (const Error&)
      {
        ++refused;
      }
    }
  }
  EXPECT_GT (refused, 60);
}

TEST_F (PcdView, SameForAnyNumberOfThreads)
{
  pcl::io::savePCDFileBinary (path ("a.pcd"), hemisphere (2000));
  PcdViewOptions options;
  options.threads = 1;
  const auto one = readPcdView (path ("a.pcd"), options).objects.at (1).points;
  options.threads = 4;
  const auto four = readPcdView (path ("a.pcd"), options).objects.at (1).points;
  ASSERT_EQ (one.size (), four.size ());
  for (std::size_t i = 0; i < one.size (); ++i)
    ASSERT_TRUE (one[i].normal == four[i].normal);
}

TEST_F (PcdView, RefusesWrongOptions)
{
  PcdViewOptions options;
  options.scale = -1.0;
  EXPECT_THROW (readPcdView ("x.pcd", options), InvalidArgument);
  options = {};
  options.viewpoint = {0.0, 1e300, 1.0};
  EXPECT_THROW (readPcdView ("x.pcd", options), InvalidArgument);
  options = {};
  options.intrinsics = {0.0, 1.0, 1.0, 1.0};
  EXPECT_THROW (readPcdView ("x.pcd", options), InvalidArgument);
}
