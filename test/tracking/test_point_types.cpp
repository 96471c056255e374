// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_registration.h>
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/point_types.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;

namespace {

/** \brief Fails to link if a header declares a class as compiled that the library does not have. */
template <typename PointT> class TrackingPointTypes : public testing::Test
{};

using XyzPoints = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointXYZRGBA, pcl::PointXYZRGBL,
                                 pcl::PointNormal, pcl::PointXYZRGBNormal, pcl::PointXYZINormal>;
TYPED_TEST_SUITE (TrackingPointTypes, XyzPoints, );

} // namespace

TYPED_TEST (TrackingPointTypes, AreInTheLibrary)
{
  SdfRegistration<TypeParam> registration;
  typename pcl::PointCloud<TypeParam>::Ptr cloud (new pcl::PointCloud<TypeParam> (3, 1));
  registration.setInputSource (cloud);
  EXPECT_EQ (registration.getInputSource ()->size (), 3u);
  SdfTracker<TypeParam> tracker;
  tracker.setInputCloud (cloud);
  EXPECT_EQ (tracker.getInputCloud ()->size (), 3u);
}
