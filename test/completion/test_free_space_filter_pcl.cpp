// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"
#include "free_space_scene.h"

#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/common/io.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

// FreeSpaceFilter as a PCL filter.

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Filter = FreeSpaceFilter<pcl::PointXYZ>;

/** \brief Three views, and their points with those of a ghost ball; every hundredth point is not finite. */
class FreeSpaceFilterPclTest : public testing::Test
{
protected:
  FreeSpaceFilterPclTest ()
  {
    addViews (views_, filter_);
    for (std::size_t i = 0; i < cloud_->size (); i += 100)
      (*cloud_)[i].y = not_a_number;
    cloud_->is_dense = false;
    cloud_->header.frame_id = "table";
    filter_.setInputCloud (cloud_);
  }

  pcl::Indices finite (const pcl::Indices& indices) const
  {
    pcl::Indices out;
    std::copy_if (indices.begin (), indices.end (), std::back_inserter (out), [&] (auto i) { return i % 100 != 0; });
    return out;
  }

  pcl::Indices filtered (bool negative)
  {
    filter_.setNegative (negative);
    pcl::Indices indices;
    filter_.filter (indices);
    return indices;
  }

  const std::vector<DepthView> views_ = renderTable (tableScene (), 1.0);
  const Points::Ptr cloud_ = pcl::make_shared<Points> (ghosts () + *merged (views_));
  Filter filter_{true};
};

pcl::Indices
iota (std::size_t count)
{
  pcl::Indices indices (count);
  std::iota (indices.begin (), indices.end (), 0);
  return indices;
}

} // namespace

TEST_F (FreeSpaceFilterPclTest, PassedAndRemovedShareThePoints)
{
  for (const bool negative : {false, true})
  {
    pcl::Indices all = filtered (negative);
    EXPECT_TRUE (std::is_sorted (all.begin (), all.end ()));
    const pcl::Indices& removed = *filter_.getRemovedIndices ();
    EXPECT_TRUE (std::is_sorted (removed.begin (), removed.end ()));
    EXPECT_EQ (std::count_if (removed.begin (), removed.end (), [] (auto i) { return i % 100 == 0; }),
               static_cast<std::ptrdiff_t> ((cloud_->size () + 99) / 100));
    all.insert (all.end (), removed.begin (), removed.end ());
    std::sort (all.begin (), all.end ());
    EXPECT_EQ (all, iota (cloud_->size ()));
  }
}

TEST_F (FreeSpaceFilterPclTest, NegativeIsTheRestOfTheFinitePoints)
{
  const pcl::Indices negative = filtered (true);
  pcl::Indices both = filtered (false);
  EXPECT_GE (negative.size (), 495u); // the ghosts
  both.insert (both.end (), negative.begin (), negative.end ());
  std::sort (both.begin (), both.end ());
  EXPECT_EQ (both, finite (iota (cloud_->size ())));
}

TEST_F (FreeSpaceFilterPclTest, RemovedIndicesAreKeptOnlyOnDemand)
{
  Filter filter;
  addViews (views_, filter);
  EXPECT_FALSE (passing (filter, cloud_).empty ());
  EXPECT_TRUE (filter.getRemovedIndices ()->empty ());
}

/** \brief Indices keep their order, which need not be ascending. */
TEST_F (FreeSpaceFilterPclTest, HonoursIndices)
{
  const pcl::Indices of_all = filtered (false);
  auto some = pcl::make_shared<pcl::Indices> ();
  for (auto i = static_cast<pcl::index_t> (cloud_->size ()) - 1; i >= 0; i -= 7)
    some->push_back (i);
  filter_.setIndices (some);
  const pcl::Indices of_some = filtered (false);
  pcl::Indices expected;
  std::copy_if (some->begin (), some->end (), std::back_inserter (expected),
                [&] (auto i) { return std::binary_search (of_all.begin (), of_all.end (), i); });
  EXPECT_EQ (of_some, expected);
  EXPECT_EQ (of_some.size () + filter_.getRemovedIndices ()->size (), some->size ());

  filter_.filter (*some); // in place
  EXPECT_EQ (*some, expected);
}

TEST_F (FreeSpaceFilterPclTest, WritesAClouds)
{
  const pcl::Indices expected = filtered (false);
  Points output;
  filter_.filter (output);
  EXPECT_EQ (output.header.frame_id, "table");
  ASSERT_EQ (output.size (), expected.size ());
  for (std::size_t n = 0; n < expected.size (); ++n)
    ASSERT_EQ (output[n].getVector3fMap (), (*cloud_)[expected[n]].getVector3fMap ());

  filter_.filter (*cloud_); // in place
  EXPECT_EQ (cloud_->size (), expected.size ());
}

TEST_F (FreeSpaceFilterPclTest, KeepsAnOrganisedCloudOrganised)
{
  DepthView view = views_.front ();
  for (int v = 30; v < 45; ++v) // a ghost, nearer than everything
    for (int u = 70; u < 90; ++u)
      view.depth[static_cast<std::size_t> (v) * view.camera.width + u] = 0.3f;
  const auto organised = pcl::make_shared<Points> (toCloud (view, true));
  organised->points[5].x = not_a_number;
  for (const float value : {not_a_number, -1.0f})
  {
    filter_.setInputCloud (organised);
    filter_.setKeepOrganized (true);
    filter_.setUserFilterValue (value);
    Points output;
    filter_.filter (output);
    ASSERT_EQ (output.width, organised->width);
    ASSERT_EQ (output.height, organised->height);
    EXPECT_FALSE (output.is_dense);
    std::vector<bool> removed (output.size (), false);
    for (const auto i : *filter_.getRemovedIndices ())
      removed[i] = true;
    EXPECT_TRUE (removed[5]);
    EXPECT_TRUE (removed[40 * view.camera.width + 80]);
    for (std::size_t i = 0; i < output.size (); ++i)
      if (!removed[i])
        ASSERT_EQ (output[i].getVector3fMap (), (*organised)[i].getVector3fMap ());
      else if (std::isnan (value))
        ASSERT_TRUE (std::isnan (output[i].x) && std::isnan (output[i].z));
      else
        ASSERT_TRUE (output[i].x == value && output[i].z == value);
    EXPECT_GE (filter_.getRemovedIndices ()->size (), 270u) << "but for where the views have a depth edge";
    EXPECT_LE (filter_.getRemovedIndices ()->size (), 301u);
  }
}

TEST_F (FreeSpaceFilterPclTest, WithoutAViewEveryFinitePointPasses)
{
  filter_.clearViews ();
  EXPECT_EQ (filtered (false), finite (iota (cloud_->size ())));
  EXPECT_TRUE (filtered (true).empty ());
}

TEST_F (FreeSpaceFilterPclTest, WorksThroughTheBaseClass)
{
  const pcl::Indices expected = filtered (false);
  auto filter = pcl::make_shared<Filter> ();
  addViews (views_, *filter);
  const pcl::FilterIndices<pcl::PointXYZ>::Ptr base = filter;
  base->setInputCloud (cloud_);
  pcl::Indices indices;
  base->filter (indices);
  EXPECT_EQ (indices, expected);
  EXPECT_NE (dynamic_cast<pcl::Filter<pcl::PointXYZ>*> (base.get ()), nullptr);
}

template <typename PointT> class FreeSpaceFilterTypes : public testing::Test
{};

using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointXYZRGBA, pcl::PointXYZRGBL,
                                  pcl::PointNormal, pcl::PointXYZRGBNormal, pcl::PointXYZINormal>;
TYPED_TEST_SUITE (FreeSpaceFilterTypes, PointTypes);

TYPED_TEST (FreeSpaceFilterTypes, AreFilteredAlike)
{
  const DepthView view = renderTable (tableScene (), 0.0, {tablePoses ().front ()}).front ();
  auto cloud = pcl::make_shared<pcl::PointCloud<TypeParam>> ();
  pcl::copyPointCloud (ghosts () + *merged ({view}), *cloud);
  Filter of_positions;
  of_positions.addView (view);
  const auto positions = pcl::make_shared<Points> ();
  pcl::copyPointCloud (*cloud, *positions);
  const pcl::Indices expected = passing (of_positions, positions);
  EXPECT_LT (expected.size () + 400, cloud->size ()); // a single view cannot see all around the ghost

  FreeSpaceFilter<TypeParam> filter;
  pcl::PointCloud<TypeParam> of_view, output;
  pcl::copyPointCloud (toCloud (view, false), of_view);
  ASSERT_TRUE (filter.addView (of_view, view.T_world_sensor));
  filter.setInputCloud (cloud);
  filter.filter (output);
  ASSERT_EQ (output.size (), expected.size ());
  for (std::size_t n = 0; n < expected.size (); ++n)
    ASSERT_EQ (output[n].getVector3fMap (), (*cloud)[expected[n]].getVector3fMap ());
}

TEST (FreeSpaceFilterChain, FromMergedViewsToClosedMeshes)
{
  const std::vector<DepthView> views = renderTable (tableScene (), 1.0);
  const auto cloud = pcl::make_shared<Points> (*merged (views) + ghosts (5000));
  const auto thinned = pcl::make_shared<Points> ();
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud (cloud);
  grid.setLeafSize (0.004f, 0.004f, 0.004f);
  grid.filter (*thinned);

  const auto inliers = pcl::make_shared<Points> ();
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> outliers;
  outliers.setInputCloud (thinned);
  outliers.setMeanK (20);
  outliers.setStddevMulThresh (3.0);
  outliers.filter (*inliers);

  FreeSpaceFilter<pcl::PointXYZ> free_space;
  addViews (views, free_space);
  const auto real = pcl::make_shared<pcl::PointIndices> ();
  real->indices = passing (free_space, inliers);
  EXPECT_LT (real->indices.size (), inliers->size ());

  const auto objects = pcl::make_shared<Points> ();
  pcl::ExtractIndices<pcl::PointXYZ> extract;
  extract.setInputCloud (inliers);
  extract.setIndices (real);
  extract.filter (*objects);
  objects->erase (std::remove_if (objects->begin (), objects->end (), [] (const auto& p) { return p.z < 0.01f; }),
                  objects->end ());

  std::vector<pcl::PointIndices> clusters;
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> clustering;
  clustering.setInputCloud (objects);
  clustering.setClusterTolerance (0.012);
  clustering.setMinClusterSize (50);
  clustering.extract (clusters);
  ASSERT_EQ (clusters.size (), 2u) << "the ball and the box, without the ghost";

  for (const pcl::PointIndices& cluster : clusters)
  {
    const auto points = pcl::make_shared<Points> (*objects, cluster.indices);
    const auto oriented = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>> ();
    pcl::copyPointCloud (*points, *oriented);
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::PointNormal> normals;
    normals.setInputCloud (points);
    normals.setKSearch (20);
    normals.setViewPoint (0.0f, 0.0f, 2.0f);
    normals.compute (*oriented);
    HessianIMLS<pcl::PointNormal> imls;
    imls.setInputCloud (oriented);
    imls.setVoxelSize (0.01f);
    for (const DepthView& view : views)
      imls.addView (view);
    pcl::PolygonMesh mesh;
    imls.reconstruct (mesh);
    EXPECT_FALSE (mesh.polygons.empty ());
    EXPECT_TRUE (computeTopology (imls.getTriangleMesh ()).closed_manifold);
  }
}

TEST (FreeSpaceFilterBadInput, GivesNothing)
{
  Filter filter;
  addViews (renderTable (tableScene (), 0.0, {tablePoses ().front ()}), filter);
  pcl::Indices indices;
  filter.filter (indices); // no cloud
  EXPECT_TRUE (indices.empty ());
  EXPECT_TRUE (passing (filter, pcl::make_shared<Points> ()).empty ());
  filter.setIndices (pcl::make_shared<pcl::Indices> ());
  EXPECT_TRUE (passing (filter, pcl::make_shared<Points> (ghosts ())).empty ());
}

/** \brief Views in the frame of the filtered cloud, as after pcl::transformPointCloud. */
TEST_F (FreeSpaceFilterPclTest, ViewsMayBeInTheFrameOfTheCloud)
{
  Filter same;
  same.setInputCloud (cloud_);
  for (const DepthView& view : views_)
    EXPECT_TRUE (same.addView (toCloud (view, true)));
  pcl::Indices indices;
  same.filter (indices);
  EXPECT_EQ (indices, filtered (false));
}

TEST (FreeSpaceFilterBadInput, ViewsThatAreNone)
{
  const DepthView view = renderTable (tableScene (), 0.0, {tablePoses ().front ()}).front ();
  Filter filter;
  EXPECT_FALSE (filter.addView (ghosts ())) << "not organised";
  EXPECT_FALSE (filter.addView (Points (160, 120))) << "without a reading";
  Points flat = toCloud (view, true);
  for (auto& p : flat)
    p.z = 0.0f;
  EXPECT_FALSE (filter.addView (flat)) << "not as any camera sees it";
  Points torn = toCloud (view, false);
  torn.points.pop_back ();
  EXPECT_FALSE (filter.addView (torn)) << "of a wrong size";

  DepthView bad = view;
  bad.depth.pop_back ();
  EXPECT_FALSE (filter.addView (bad));
  bad = view;
  bad.camera.fx = 0.0;
  EXPECT_FALSE (filter.addView (bad));
  bad = view;
  bad.T_world_sensor.translation ().x () = not_a_number;
  EXPECT_FALSE (filter.addView (bad));

  const auto cloud = pcl::make_shared<Points> (ghosts ());
  EXPECT_EQ (passing (filter, cloud).size (), cloud->size ()) << "none of them was added";
}

TEST (FreeSpaceFilterBadInput, Parameters)
{
  Filter filter;
  EXPECT_FALSE (filter.setMargin (-0.01f));
  EXPECT_FALSE (filter.setMargin (not_a_number));
  EXPECT_FALSE (filter.setMinimumViews (0));
  filter.setMargin (0.02f);
  filter.setMinimumViews (2);
  EXPECT_EQ (filter.getMargin (), 0.02f);
  EXPECT_EQ (filter.getMinimumViews (), 2);
}

TEST (FreeSpaceFilterBadInput, PointsFarOff)
{
  Filter filter;
  addViews (renderTable (tableScene ()), filter);
  auto cloud = pcl::make_shared<Points> ();
  for (const float far : {1e10f, -1e10f, 1e38f, -1e38f})
    for (int axis = 0; axis < 3; ++axis)
    {
      pcl::PointXYZ p (0.0f, 0.0f, 0.0f);
      p.getVector3fMap ()[axis] = far;
      cloud->push_back (p);
    }
  EXPECT_EQ (passing (filter, cloud).size (), cloud->size ()) << "no view sees them";
}
