// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The class as a user of PCL has it.

#include <pcl/cosection/segmentation/instance_segmentation.h>

#include "common/temporary_folder.h"
#include "spot_network.h"

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

using namespace pcl::cosection;
using test::SpotNetwork;

namespace {

class Segmentation : public testing::Test
{
protected:
  using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

  /** \brief A red spot of 6 x 4 pixels from (8, 6) on, as a cloud. */
  Segmentation ()
  {
    pcl::console::setVerbosityLevel (pcl::console::L_ALWAYS);
    std::ofstream (folder_.file ("spot.onnx"), std::ios::binary)
        << affineOnnx (SpotNetwork::width, SpotNetwork::height, SpotNetwork{NetworkOutputForm::Prototypes}.outputs ());
    options_.model = folder_.file ("spot.onnx");
    options_.input_width = SpotNetwork::width;
    options_.input_height = SpotNetwork::height;
    options_.detection.class_names = {"person", "table", "cup"};
    const Picture picture = test::spotPicture (8, 6);
    for (int v = 0; v < picture.height; ++v)
      for (int u = 0; u < picture.width; ++u)
      {
        pcl::PointXYZRGB& p = (*cloud_) (u, v);
        p.getVector3fMap () = Eigen::Vector3f (0.01f * u, 0.01f * v, 1.0f);
        p.r = picture.at (u, v)[0];
        p.g = picture.at (u, v)[1];
        p.b = picture.at (u, v)[2];
      }
    cloud_->header.frame_id = "camera";
    segmentation_.setInputCloud (cloud_);
  }

  ~Segmentation () override { pcl::console::setVerbosityLevel (pcl::console::L_INFO); }

  void expectNothing ()
  {
    segmentation_.segment (labels_, label_indices_);
    EXPECT_TRUE (labels_.empty ());
    EXPECT_TRUE (label_indices_.empty ());
    EXPECT_TRUE (segmentation_.getInstances ().empty ());
  }

  const test::TemporaryFolder folder_;
  InstanceDetectorOptions options_;
  Cloud::Ptr cloud_{new Cloud (SpotNetwork::width, SpotNetwork::height)};
  InstanceSegmentation<pcl::PointXYZRGB> segmentation_;
  pcl::PointCloud<pcl::Label> labels_;
  std::vector<pcl::PointIndices> label_indices_;
};

} // namespace

TEST_F (Segmentation, FindsTheCup)
{
  segmentation_.setNetwork (options_, {{"cup"}, {}, {}});
  segmentation_.segment (labels_, label_indices_);
  ASSERT_EQ (labels_.width, cloud_->width);
  ASSERT_EQ (labels_.height, cloud_->height);
  EXPECT_EQ (labels_.header.frame_id, "camera");
  ASSERT_EQ (label_indices_.size (), 1u);
  EXPECT_EQ (label_indices_[0].indices.size (), 24u);
  for (const auto i : label_indices_[0].indices)
  {
    EXPECT_EQ ((*cloud_)[i].r, 255);
    EXPECT_EQ (labels_[i].label, 1u);
  }
  ASSERT_EQ (segmentation_.getInstances ().size (), 1u);
  EXPECT_EQ (segmentation_.getInstances ()[0].class_name, "cup");
  EXPECT_NEAR (segmentation_.getInstances ()[0].score, 0.9, 1e-5);
}

TEST_F (Segmentation, OnlyPointsThatCount)
{
  segmentation_.setNetwork (options_);
  (*cloud_) (8, 6).z = std::numeric_limits<float>::quiet_NaN ();
  pcl::IndicesPtr indices (new pcl::Indices);
  for (std::size_t i = 0; i < cloud_->size () / 2; ++i) // the upper half: two rows of the spot
    indices->push_back (static_cast<pcl::index_t> (i));
  segmentation_.setIndices (indices);
  segmentation_.segment (labels_, label_indices_);
  ASSERT_EQ (label_indices_.size (), 1u);
  EXPECT_EQ (label_indices_[0].indices.size (), 2u * 6u - 1u);
  EXPECT_EQ (labels_ (8, 6).label, 0u);
  EXPECT_EQ (labels_ (9, 9).label, 0u);
}

TEST_F (Segmentation, IgnoredClassesAreNoObjects)
{
  segmentation_.setNetwork (options_, {{}, {}, {"cup"}});
  segmentation_.segment (labels_, label_indices_);
  EXPECT_TRUE (label_indices_.empty ());
  ASSERT_EQ (labels_.size (), cloud_->size ());
  EXPECT_EQ (labels_ (9, 9).label, ignored_label);
}

TEST_F (Segmentation, NothingFoundIsNoError)
{
  options_.detection.score_threshold = 0.99;
  segmentation_.setNetwork (options_);
  segmentation_.segment (labels_, label_indices_);
  EXPECT_EQ (labels_.size (), cloud_->size ());
  EXPECT_TRUE (label_indices_.empty ());
}

TEST_F (Segmentation, WithoutWhatItNeedsItSaysSo)
{
  expectNothing (); // no network
  EXPECT_FALSE (segmentation_.setNetwork (options_, {{"bottle"}, {}, {}}));
  segmentation_.setNetwork (options_);
  Cloud::Ptr changed (new Cloud (*cloud_));
  for (auto& p : *changed)
    p.r = p.g = p.b = 0;
  segmentation_.setInputCloud (changed);
  expectNothing ();
  changed.reset (new Cloud (*cloud_));
  changed->width *= changed->height;
  changed->height = 1;
  segmentation_.setInputCloud (changed);
  expectNothing ();
  segmentation_.setInputCloud (nullptr);
  expectNothing ();
  options_.input_width = options_.input_height = 64; // not this network's
  segmentation_.setNetwork (options_);
  segmentation_.setInputCloud (cloud_);
  expectNothing ();
}
