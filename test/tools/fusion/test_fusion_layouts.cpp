// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Sequences as benchmarks, phones and turntables have them.

#include "fusion_scene.h"

#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/io/mask_image.h"
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/mesh_io.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class FusionLayouts : public FusionScene
{
protected:
  double volume (const std::string& name) const { return (computeMassProperties (loadMesh (file (name))).volume_m3); }

  /** \brief Calls change (number of the frame, its depths, its mask) for all frames. */
  template <typename Change> void changeDepths (Change&& change) const
  {
    for (const auto& entry : fs::directory_iterator (file ("sim/depth_noise")))
    {
      const std::string path = entry.path ().string (), number = entry.path ().stem ().string ().substr (5);
      Image<float> depth = loadDepthImage (path, 1000.0);
      change (std::stoi (number), depth, loadMaskImage (file ("sim/mask/Mask" + number + ".png")));
      saveDepthImage (depth, path, 1000.0);
    }
  }
};

} // namespace

TEST_F (FusionLayouts, CameraIsAtRestWhereOnlyObjectsHaveReadings)
{
  changeDepths ([] (int, Image<float>& depth, const Image<std::uint16_t>& mask) {
    for (std::size_t n = 0; n < depth.pixels.size (); ++n)
      if (mask.pixels[n] == 0)
        depth.pixels[n] = std::numeric_limits<float>::quiet_NaN ();
  });
  ASSERT_EQ (run ({"--masks", "sim/mask", "--json", "s.json", "sim", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("in 12 of 12 frames only objects have readings: the camera was taken to be at rest"),
             std::string::npos)
      << errors_;
  EXPECT_EQ (json ("out/summary.json")["frames"], 12);
  EXPECT_EQ (json ("out/summary.json")["frames_left_out"], 0);
}

TEST_F (FusionLayouts, ARunThatLeavesMostFramesOutFails)
{
  changeDepths ([] (int frame, Image<float>& depth, const Image<std::uint16_t>&) {
    if (frame >= 4)
      std::fill (depth.pixels.begin (), depth.pixels.end (), std::numeric_limits<float>::quiet_NaN ());
  });
  EXPECT_EQ (run ({"--masks", "sim/mask", "sim", "out"}), 1);
  EXPECT_NE (errors_.find ("error: most frames were left out: 8 of 12"), std::string::npos) << errors_;
  EXPECT_EQ (json ("out/summary.json")["frames_left_out"], 8);
}

TEST_F (FusionLayouts, ARunWhoseMasksCannotBeUsedFails)
{
  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
    saveMaskImage (Image<std::uint16_t> (60, 50, 1), entry.path ().string (), true);
  expectFailure ({"--masks", "sim/mask", "sim", "out"}, 1, "no frame has a mask that can be used");
}

TEST_F (FusionLayouts, ARunOfWhoseMasksNoObjectComesFailsAndSaysWhy)
{
  ASSERT_EQ (run ({"--masks", "sim/mask", "--depth-scale", "100", "--frames", ":2", "sim", "far"}), 1) << errors_;
  EXPECT_NE (
      errors_.find ("error: the masks show no object that could be tracked: instance 1 of the masks is no object"),
      std::string::npos)
      << errors_;
  EXPECT_NE (
      errors_.find ("m away; at most 5 m are allowed; likewise 1 more; half of the depths of the first frame are "
                    "more than "),
      std::string::npos)
      << errors_;
  EXPECT_NE (errors_.find ("give --depth-scale"), std::string::npos) << errors_;
  EXPECT_EQ (errors_.find ("warning: the masks show no object"), std::string::npos) << "it is said once";

  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
    saveMaskImage (Image<std::uint16_t> (120, 90), entry.path ().string (), true);
  const std::string all_zero = "all 4 masks are 0 in every pixel; where an object is, they must be its number";
  expectFailure ({"--masks", "sim/mask", "--frames", ":4", "sim", "tracked"}, 1,
                 "the masks show no object that could be tracked: " + all_zero);
  EXPECT_TRUE (fs::exists (file ("tracked/mesh/background.ply")));
  EXPECT_EQ (json ("tracked/summary.json")["warnings"].back (),
             "the masks show no object that could be tracked: " + all_zero);
  expectFailure (known ({"--frames", ":4", "sim", "known"}), 1, "the masks show no object: " + all_zero);
}

TEST_F (FusionLayouts, TheBenchmarkBopHasAMaskForEachInstance)
{
  // The simulated frames in that layout: rgb/, depth/, mask_visib/FRAME_INSTANCE.png and scene_camera.json.
  fs::create_directories (file ("bop/depth"));
  fs::create_directories (file ("bop/rgb"));
  fs::create_directories (file ("bop/mask_visib"));
  std::istringstream calibration (readFile (file ("sim/calibration.txt")));
  std::array<double, 4> k{};
  for (double& value : k)
    calibration >> value;
  nlohmann::json cameras;
  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
  {
    const std::string number = entry.path ().stem ().string ().substr (4), frame = "00" + number;
    cameras[std::to_string (std::stoi (number))] = {{"cam_K", {k[0], 0.0, k[2], 0.0, k[1], k[3], 0.0, 0.0, 1.0}},
                                                    {"depth_scale", 1.0}};
    saveDepthImage (loadDepthImage (file ("sim/depth_noise/Depth" + number + ".png"), 1000.0),
                    file ("bop/depth/" + frame + ".png"), 1000.0);
    for (const auto& colour : fs::directory_iterator (file ("sim/colour")))
      if (colour.path ().stem ().string ().find (number) != std::string::npos)
        fs::copy_file (colour.path (), file ("bop/rgb/" + frame + colour.path ().extension ().string ()));
    const Image<std::uint16_t> mask = loadMaskImage (entry.path ().string ());
    for (std::uint16_t id = 1; id <= 2; ++id)
    {
      Image<std::uint16_t> instance (mask.width, mask.height);
      for (std::size_t n = 0; n < mask.pixels.size (); ++n)
        instance.pixels[n] = mask.pixels[n] == id ? 255 : 0;
      saveMaskImage (instance, file ("bop/mask_visib/" + frame + "_00000" + std::to_string (id - 1) + ".png"), false);
    }
  }
  writeFile (file ("bop/scene_camera.json"), cameras.dump ());
  const Words poses = {"--camera-trajectory", "sim/gt-cam-0.txt", "--object-trajectory", "1=sim/gt-ball-1.txt"};
  Words bop = poses, simulated = poses;
  for (const char* word : {"--masks", "bop/mask_visib", "bop", "of_bop"})
    bop.push_back (word);
  for (const char* word : {"--masks", "sim/mask", "sim", "of_sim"})
    simulated.push_back (word);
  ASSERT_EQ (run (bop), 0) << errors_;
  EXPECT_EQ (errors_.find ("without colour"), std::string::npos) << errors_;
  ASSERT_EQ (run (simulated), 0) << errors_;
  for (const char* object : {"/mesh/object_1.ply", "/mesh/object_2.ply"})
    EXPECT_NEAR (volume (std::string ("of_bop") + object), volume (std::string ("of_sim") + object), 1e-6);
}
