// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/frame_segmenter.h>

#include "common/temporary_folder.h"
#include "segmentation/spot_network.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

using namespace pcl::cosection;
using test::SpotNetwork;

namespace {

class Segmenter : public testing::Test
{
protected:
  Segmenter ()
  {
    std::ofstream (folder_.file ("spot.onnx"), std::ios::binary)
        << affineOnnx (SpotNetwork::width, SpotNetwork::height, SpotNetwork{NetworkOutputForm::Prototypes}.outputs ());
    options_.model = folder_.file ("spot.onnx");
    options_.input_width = SpotNetwork::width;
    options_.input_height = SpotNetwork::height;
    options_.detection.class_names = {"table", "person", "cup"};
    images_.colour = test::spotPicture (8, 6);
  }

  FrameInstances segment (const ClassRoles& roles) const
  {
    return (NetworkSegmenter (options_, roles).segment ({images_, camera_, points_, pose_, {}, labels_, moving_}));
  }

  static std::ptrdiff_t count (const FrameInstances& found, std::uint16_t label)
  {
    return (std::count (found.mask->pixels.begin (), found.mask->pixels.end (), label));
  }

  const test::TemporaryFolder folder_;
  InstanceDetectorOptions options_;
  RgbdFrame images_;

private:
  const PinholeCamera camera_;
  const std::vector<Eigen::Vector3f> points_;
  const Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity ();
  const Image<std::uint16_t> labels_;
  const Image<std::uint8_t> moving_;
};

} // namespace

TEST_F (Segmenter, LabelsWhatTheNetworkFinds)
{
  const FrameInstances found = segment ({});
  ASSERT_TRUE (found.mask);
  EXPECT_EQ (found.note, "");
  EXPECT_EQ (found.mask->width, images_.colour.width);
  EXPECT_EQ (found.mask->at (9, 7), 1);
  EXPECT_EQ (count (found, 1), 24);
  EXPECT_EQ (count (found, 0), 24 * 16 - 24);
  ASSERT_EQ (found.classes.size (), 1u);
  EXPECT_EQ (found.classes.at (1).class_id, 2);
  EXPECT_EQ (found.classes.at (1).class_name, "cup");
  EXPECT_NEAR (found.classes.at (1).score, 0.9, 1e-6);
}

TEST_F (Segmenter, IgnoredClassesAreNeitherObjectsNorBackground)
{
  EXPECT_EQ (count (segment ({{}, {}, {"cup"}}), FrameSegmenter::ignored), 24);
  EXPECT_EQ (count (segment ({{}, {"cup"}, {}}), 0), 24 * 16);
  EXPECT_TRUE (segment ({{}, {}, {"cup"}}).classes.empty ());
  EXPECT_TRUE (segment ({{}, {"cup"}, {}}).classes.empty ());
  EXPECT_THROW (segment ({{"bottle"}, {}, {}}), InvalidArgument);
}

TEST_F (Segmenter, FramesWithoutColourTellNothing)
{
  images_.colour = Picture ();
  const FrameInstances found = segment ({});
  EXPECT_FALSE (found.mask);
  EXPECT_NE (found.note.find ("colour"), std::string::npos);
}

TEST_F (Segmenter, ANetworkThatCannotBeRunIsAnError)
{
  options_.input_width = 100;
  EXPECT_THROW (segment ({}), IoError);
}
