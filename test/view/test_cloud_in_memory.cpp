// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Views of clouds that were never files.

#include "io/pcd_view_fixture.h"

#include <pcl/cosection/common/error.h>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include <functional>
#include <limits>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

using CloudInMemory = PcdView;

TEST_F (CloudInMemory, IsTheViewOfItsFile)
{
  auto cloud = organizedStep ();
  cloud.sensor_origin_ = Eigen::Vector4f (0.5f, -0.25f, 2.0f, 0.0f);
  pcl::io::savePCDFileBinary (path ("view.pcd"), cloud);
  pcl::PCLPointCloud2 bytes;
  pcl::toPCLPointCloud2 (cloud, bytes);
  const Eigen::Isometry3d pose (Eigen::Translation3d (0.5, -0.25, 2.0));
  const LabelledView expected = readPcdView (path ("view.pcd")), view = toLabelledView (bytes, pose);
  ASSERT_EQ (view.objects.size (), expected.objects.size ());
  for (const auto& [label, object] : expected.objects)
  {
    const LabelledView::Points& mine = view.objects.at (label);
    ASSERT_EQ (mine.points.size (), object.points.size ());
    EXPECT_EQ (mine.readings, object.readings);
    for (std::size_t n = 0; n < object.points.size (); ++n)
    {
      EXPECT_EQ (mine.points[n].position, object.points[n].position);
      EXPECT_EQ (mine.points[n].normal, object.points[n].normal);
    }
  }
  ASSERT_TRUE (view.view && expected.view);
  EXPECT_EQ (view.view->T_world_sensor.matrix (), expected.view->T_world_sensor.matrix ());
}

TEST_F (CloudInMemory, WrongBytesAreRefused)
{
  pcl::PCLPointCloud2 good;
  pcl::toPCLPointCloud2 (organizedPlane (), good);
  const auto refuse = [&] (const std::string& words, const std::function<void (pcl::PCLPointCloud2&)>& spoil) {
    pcl::PCLPointCloud2 cloud = good;
    spoil (cloud);
    try
    {
      toLabelledView (cloud, Eigen::Isometry3d::Identity (), {}, "view");
      ADD_FAILURE () << words;
    }
    catch (const InvalidArgument& error)
    {
      EXPECT_EQ (std::string (error.what ()).find ("view: " + words), 0U) << error.what ();
    }
  };
  refuse ("has ", [] (auto& cloud) { cloud.data.pop_back (); });
  refuse ("has ", [] (auto& cloud) { cloud.width = 4000000000U; });
  refuse ("field x lies outside the point", [] (auto& cloud) { cloud.fields[0].offset = 4000000000U; });
  refuse ("field x lies outside the point", [] (auto& cloud) { cloud.fields[0].count = 4000000000U; });
  refuse ("field x lies outside the point", [] (auto& cloud) { cloud.point_step = 0; });
  refuse ("field x has no type", [] (auto& cloud) { cloud.fields[0].datatype = 77; });
  good.fields[0].name = "a";
  EXPECT_THROW (toLabelledView (good, Eigen::Isometry3d::Identity ()), IoError);
  EXPECT_THROW (toLabelledView ({}, Eigen::Isometry3d::Identity ()), DegenerateInput);
  Eigen::Isometry3d lost = Eigen::Isometry3d::Identity ();
  lost.translation ().x () = std::numeric_limits<double>::infinity ();
  EXPECT_THROW (toLabelledView (good, lost), InvalidArgument);
}
