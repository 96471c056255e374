// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// pcl_cosection_fusion with a network that finds red and blue things.

#include "fusion_scene.h"
#include "segmentation/spot_network.h"

#include <nlohmann/json.hpp>

namespace
{

class FusionNetwork : public FusionScene
{
protected:
  FusionNetwork ()
  {
    using pcl::cosection::test::affineOnnx;
    using pcl::cosection::test::colourNetwork;
    std::ofstream (file ("net.onnx"), std::ios::binary) << affineOnnx (24, 18, colourNetwork (24, 18, {{1, -1, 0}, {-1, 0, 1}}, 0.15f));
    std::ofstream (file ("names")) << "ball\nbox\n";
  }

  static Words
  withNetwork (Words more = {})
  {
    Words words = {"sim", "out", "--segmentation", "mask-rcnn", "--model", "net.onnx", "--class-names", "names", "--background-voxel-size", "0.03"};
    words.insert (words.end (), more.begin (), more.end ());
    return (words);
  }

  /** \brief How many objects there are in the end. */
  std::size_t
  objects () const
  {
    std::ifstream summary (file ("out/summary.json"));
    return (nlohmann::json::parse (summary)["objects"].size ());
  }
};

} // namespace

TEST_F (FusionNetwork, FindsTheObjects)
{
  ASSERT_EQ (run (withNetwork ()), 0) << errors_;
  EXPECT_EQ (objects (), 2u);
}

TEST_F (FusionNetwork, ClassesHaveRoles)
{
  ASSERT_EQ (run (withNetwork ({"--classes", "ball"})), 0) << errors_;
  EXPECT_EQ (objects (), 1u);
  ASSERT_EQ (run (withNetwork ({"--static-classes", "ball", "--ignore", "box"})), 0) << errors_;
  EXPECT_EQ (objects (), 0u);
}

TEST_F (FusionNetwork, WrongUsageIsOneLine)
{
  expectFailure ({"sim", "out", "--segmentation", "mask-rcnn"}, 2, "--model");
  expectFailure ({"sim", "out", "--segmentation", "geometric", "--model", "net.onnx"}, 2, "--segmentation mask-rcnn");
  expectFailure ({"sim", "out", "--model", "net.onnx"}, 2, "--segmentation mask-rcnn");
  expectFailure (withNetwork ({"--classes", "bal"}), 2, "did you mean ball?");
  expectFailure ({"sim", "out", "--segmentation", "mask-rcnn", "--model", "absent.onnx"}, 1, "absent.onnx");
}
