// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_fusion without masks, and with pixels that it is not to read.

#include "fusion/ball_and_box.h"
#include "fusion_scene.h"

#include "pcl_cosection/io/image_io.h"

#include <nlohmann/json.hpp>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using FusionSegmentation = FusionScene;

} // namespace

TEST_F (FusionSegmentation, ObjectsAreFoundAndCompleted)
{
  writeFile (file ("scene.json"), sceneJson (22, 240, 180, 0.7)); // that of the other tests is too coarse
  ToolRun simulation ({"scene.json", "fine"}, file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (simulation.wait (), 0) << simulation.errors ();
  ASSERT_EQ (run ({"--segmentation", "geometric", "fine", "out"}), 0) << errors_;
  const nlohmann::json result = json ("out/summary.json");
  EXPECT_EQ (result["parameters"]["segmentation"], "geometric");
  ASSERT_EQ (result["objects"].size (), 2u); // the ball and the box
  for (const auto& object : result["objects"])
  {
    EXPECT_TRUE (object["closed"]);
    EXPECT_TRUE (exists ("out/mesh/object_" + std::to_string (object["id"].get<int> ()) + ".ply"));
  }
}

TEST_F (FusionSegmentation, WrongUsage)
{
  expectFailure ({"--segmentation", "magic", "sim", "out"}, 2, "--segmentation");
  expectFailure ({"--segmentation", "geometric", "--masks", "sim/mask", "sim", "out"}, 2,
                 "--masks and --segmentation exclude each other");
  expectFailure ({"--segmentation", "geometric", "--camera-trajectory", "sim/gt-cam-0.txt", "sim", "out"}, 2,
                 "--segmentation needs tracking");
  for (const char* region : {"1,2,3", "a,b,c,d", "0,0,0,5", "-1,0,5,5", "0.5,0,5,5"})
    expectFailure ({"--ignore-region", region, "sim", "out"}, 2, "--ignore-region must be");
  expectFailure ({"--ignore-region", "100,0,21,5", "sim", "out"}, 2, "not within the images, which are 120 x 90");
  expectFailure ({"--ignore-mask", "none.png", "sim", "out"}, 1, "none.png");
  saveMaskImage (Image<std::uint16_t> (20, 10, 1), file ("small.png"));
  expectFailure ({"--ignore-mask", "small.png", "sim", "out"}, 1, "small.png: is 20 x 10, the images are 120 x 90");
  EXPECT_FALSE (exists ("out"));
}

TEST_F (FusionSegmentation, IgnoredPixelsAreNotCompleted)
{
  Image<std::uint16_t> mask (120, 90, 0);
  for (int v = 0; v < 90; ++v)
    for (int u = 30; u < 60; ++u)
      mask.at (u, v) = 200;
  saveMaskImage (mask, file ("left.png"));
  ASSERT_EQ (run (known ({"--ignore-region", "0,0,15,90", "--ignore-region", "15,0,15,90", "--ignore-mask", "left.png",
                          "sim", "out"})),
             0)
      << errors_;
  const nlohmann::json result = json ("out/summary.json");
  ASSERT_EQ (result["parameters"]["ignored_regions"].size (), 2u);
  ASSERT_EQ (result["objects"].size (), 1u) << result["objects"]; // the ball is in the left half of the images
  EXPECT_EQ (result["objects"][0]["id"], 2);
}
