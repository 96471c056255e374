// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "table_view.h"

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;

class PclSegmentation : public testing::Test
{
protected:
  PclSegmentation ()
  {
    pcl::console::setVerbosityLevel (pcl::console::L_ALWAYS);
    const SceneView view = viewOfTable (boxOnTable (1, {0.10, 0.10, 0.12}, {-0.2, 0, 0}, 20) +
                                        boxOnTable (2, {0.2, 0.12, 0.05}, {0.1, 0, 0}, -15));
    cloud_->resize (view.points.size ());
    cloud_->width = view.width;
    cloud_->height = view.height;
    cloud_->is_dense = false;
    cloud_->header.frame_id = "camera";
    for (std::size_t i = 0; i < view.points.size (); ++i)
      (*cloud_)[i].getVector3fMap () = view.points[i];
  }

  ~PclSegmentation () override { pcl::console::setVerbosityLevel (pcl::console::L_INFO); }

  const Points::Ptr cloud_{new Points};
  GeometricSegmentation<pcl::PointXYZ> segmentation_;
  pcl::PointCloud<pcl::Label> labels_;
  std::vector<pcl::PointIndices> indices_;
};

} // namespace

TEST_F (PclSegmentation, LabelsAndIndicesAgree)
{
  segmentation_.setInputCloud (cloud_);
  segmentation_.segment (labels_, indices_);
  ASSERT_EQ (indices_.size (), 2u);
  EXPECT_EQ (labels_.width, cloud_->width);
  EXPECT_EQ (labels_.height, cloud_->height);
  EXPECT_EQ (labels_.header.frame_id, "camera");
  std::size_t labelled = 0;
  for (const pcl::Label& label : labels_)
    labelled += label.label > 0;
  for (std::size_t k = 0; k < indices_.size (); ++k)
  {
    for (const auto i : indices_[k].indices)
      EXPECT_EQ (labels_[i].label, k + 1);
    labelled -= indices_[k].indices.size ();
  }
  EXPECT_EQ (labelled, 0u);
  ASSERT_FALSE (segmentation_.getSupportPlanes ().empty ());
  EXPECT_EQ (segmentation_.getSupportPlanes ()[0].values.size (), 4u);
}

TEST_F (PclSegmentation, OnlyTheIndicesCount)
{
  segmentation_.setInputCloud (cloud_);
  segmentation_.segment (labels_, indices_);
  ASSERT_EQ (indices_.size (), 2u);
  const pcl::PointIndices first = indices_[0];
  pcl::IndicesPtr others (new pcl::Indices);
  for (std::size_t i = 0; i < cloud_->size (); ++i)
    if (labels_[i].label != 1)
      others->push_back (static_cast<pcl::index_t> (i));
  segmentation_.setIndices (others);
  segmentation_.segment (labels_, indices_);
  EXPECT_EQ (labels_.size (), cloud_->size ());
  EXPECT_EQ (indices_.size (), 1u);
  for (const auto i : first.indices)
    EXPECT_EQ (labels_[i].label, 0u);
}

TEST_F (PclSegmentation, NothingToWorkOn)
{
  labels_.resize (3);
  indices_.resize (3);
  segmentation_.segment (labels_, indices_);
  EXPECT_TRUE (labels_.empty () && indices_.empty ());
  segmentation_.setInputCloud (Points::Ptr (new Points (100, 1)));
  segmentation_.segment (labels_, indices_);
  EXPECT_TRUE (labels_.empty () && indices_.empty ());
  segmentation_.setInputCloud (Points::Ptr (new Points (64, 48)));
  segmentation_.segment (labels_, indices_);
  EXPECT_TRUE (labels_.empty () && indices_.empty ());
}

TEST_F (PclSegmentation, ParametersAreChecked)
{
  EXPECT_FALSE (segmentation_.setMaximumObjectSize (0.01));
  EXPECT_FALSE (segmentation_.setMinimumObjectSize (0.0));
  EXPECT_FALSE (segmentation_.setConcaveAngle (4.0));
  segmentation_.setMaximumObjectSize (0.08);
  EXPECT_EQ (segmentation_.getMaximumObjectSize (), 0.08);
  segmentation_.setInputCloud (cloud_);
  segmentation_.segment (labels_, indices_);
  EXPECT_TRUE (indices_.empty ()) << "both are larger";
  EXPECT_EQ (labels_.size (), cloud_->size ());
}
