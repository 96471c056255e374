// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/temporary_folder.h"

#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/io/trajectory.h>
#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

SimulatedScene
smallScene ()
{
  return parseSceneSpec (R"({
    "frames": 7, "rate": 5,
    "camera": {"width": 96, "height": 72,
               "keys": [{"position": [0, -1, 0.5], "look_at": [0, 0, 0]}, {"time": 1, "position": [0.2, -1, 0.5],
                 "look_at": [0, 0, 0]}]},
    "views": {"every": 3},
    "background": {"parts": [{"type": "plane"}]},
    "objects": [
      {"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "keys": [{"position": [0, 0, 0.1]}, {"time": 1,
        "position": [0.1, 0, 0.1]}]},
      {"name": "box", "id": 9, "shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "keys": [{"position": [-0.2, 0.1,
        0.05]}]}
    ]
  })",
                         "small");
}

std::map<std::string, std::string>
contents (const fs::path& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator (folder))
    if (entry.is_regular_file ())
    {
      std::ifstream in (entry.path (), std::ios::binary);
      files[fs::relative (entry.path (), folder).string ()] = {std::istreambuf_iterator<char> (in), {}};
    }
  return files;
}

} // namespace

TEST (SequenceWriter, WritesTheLayout)
{
  const test::TemporaryFolder folder;
  const SimulatedScene scene = smallScene ();
  writeSequence (scene, folder.file ("out"));
  const auto files = contents (folder.file ("out"));
  for (const char* name :
       {"calibration.txt", "scene.json", "colour/Color0000.png", "colour/Color0006.png", "depth_noise/Depth0003.png",
        "mask/Mask0006.png", "gt-cam-0.txt", "gt-ball-1.txt", "gt-box-9.txt", "gt-mesh/ball.ply", "gt-mesh/box.ply",
        "gt-mesh/room.ply", "views/View0000.pcd", "views/View0002.pcd", "views/gt-ball-1.txt"})
    EXPECT_EQ (files.count (name), 1u) << name;
  EXPECT_EQ (files.size (), 2u + 3 * 7 + 3 + 3 + 3 + 3);
  EXPECT_EQ (files.at ("calibration.txt"), "78.75 78.75 47.5 35.5 96 72\n");
  EXPECT_EQ (folder.entries (), 1u); // nothing temporary is left

  const auto camera = loadTrajectory (folder.file ("out/gt-cam-0.txt"));
  ASSERT_EQ (camera.size (), 7u);
  EXPECT_EQ (camera[4].stamp, 4.0);
  EXPECT_TRUE (camera[4].pose.isApprox (scene.camera_motion.at (scene.timeOf (4)), 1e-8));
  const auto ball = loadTrajectory (folder.file ("out/views/gt-ball-1.txt"));
  ASSERT_EQ (ball.size (), 3u);
  EXPECT_TRUE (ball[1].pose.isApprox (scene.bodies[1].motion.at (scene.timeOf (3)), 1e-8));
  EXPECT_TRUE (computeTopology (loadPlyMesh (folder.file ("out/gt-mesh/ball.ply"))).closed_manifold);

  const SimulatedFrame frame = SceneRenderer (scene).render (scene.timeOf (3));
  EXPECT_EQ (loadMaskImage (folder.file ("out/mask/Mask0003.png")).pixels, frame.mask.pixels);
  EXPECT_EQ (loadColourImage (folder.file ("out/colour/Color0003.png")).pixels, frame.colour.pixels);
}

TEST (SequenceWriter, ViewsAreReadAsViews)
{
  const test::TemporaryFolder folder;
  const SimulatedScene scene = smallScene ();
  writeSequence (scene, folder.file ("out"));
  const LabelledView view = readPcdView (folder.file ("out/views/View0001.pcd"));
  ASSERT_TRUE (view.view);
  EXPECT_TRUE (view.organized && view.has_labels && view.has_colour);
  EXPECT_NEAR (view.view->camera.fx, scene.camera.fx, 0.01);
  EXPECT_TRUE (view.view->T_world_sensor.isApprox (scene.camera_motion.at (scene.timeOf (3)), 1e-4));
  EXPECT_EQ (view.objects.count (9), 1u);
  double sum = 0.0;
  for (const OrientedPoint& p : view.objects.at (1).points)
    sum += std::abs (scene.bodies[1].distance (scene.bodies[1].motion.at (scene.timeOf (3)).inverse () *
                                               p.position.cast<double> ()));
  EXPECT_LE (sum / static_cast<double> (view.objects.at (1).points.size ()), 0.02);
}

TEST (SequenceWriter, ExactDepthIsExact)
{
  const test::TemporaryFolder folder;
  SimulatedScene scene = smallScene ();
  scene.noise.reset ();
  scene.frames = 1;
  scene.depth_format = DepthFormat::Exr;
  writeSequence (scene, folder.file ("exr"));
  const Image<float> truth = SceneRenderer (scene).render (0.0).depth;
  const Image<float> read = loadDepthImage (folder.file ("exr/depth/Depth0000.exr"));
  for (std::size_t n = 0; n < truth.pixels.size (); ++n)
    ASSERT_TRUE (read.pixels[n] == truth.pixels[n] ||
                 (!std::isfinite (read.pixels[n]) && !std::isfinite (truth.pixels[n])));
  scene.depth_format = DepthFormat::Png;
  scene.depth_scale = 5000.0;
  writeSequence (scene, folder.file ("png"));
  const Image<float> rounded = loadDepthImage (folder.file ("png/depth/Depth0000.png"), 5000.0);
  for (std::size_t n = 0; n < truth.pixels.size (); ++n)
    if (truth.pixels[n] * 5000.0 < 65535.0)
    {
      ASSERT_NEAR (rounded.pixels[n], truth.pixels[n], 1.01e-4);
    }
}

TEST (SequenceWriter, SameSeedSameBytesForAnyThreadsAndPart)
{
  const test::TemporaryFolder folder;
  SimulatedScene scene = smallScene ();
  SequenceOptions options;
  options.threads = 1;
  writeSequence (scene, folder.file ("one"), options);
  options.threads = 3;
  writeSequence (scene, folder.file ("three"), options);
  const auto one = contents (folder.file ("one"));
  EXPECT_EQ (one, contents (folder.file ("three")));
  options.first = 2;
  options.last = 5;
  writeSequence (scene, folder.file ("part"), options);
  const auto part = contents (folder.file ("part"));
  int same = 0;
  for (const auto& [name, bytes] : part)
    if (name.find ("Depth") != std::string::npos || name.find ("Color") != std::string::npos)
    {
      EXPECT_EQ (one.at (name), bytes) << name;
      ++same;
    }
  EXPECT_EQ (same, 6);
  EXPECT_EQ (part.count ("views/View0000.pcd"), 1u); // of frame 3
  EXPECT_EQ (part.count ("views/View0001.pcd"), 0u);
  scene.seed = 2;
  writeSequence (scene, folder.file ("other"));
  EXPECT_NE (one.at ("depth_noise/Depth0000.png"), contents (folder.file ("other")).at ("depth_noise/Depth0000.png"));
  EXPECT_EQ (one.at ("colour/Color0000.png"), contents (folder.file ("other")).at ("colour/Color0000.png"));
}

TEST (SequenceWriter, LeavesNothingWhenItFails)
{
  const test::TemporaryFolder folder;
  const SimulatedScene scene = smallScene ();
  EXPECT_THROW (writeSequence (scene, folder.file ("out"), {}, [] (const std::string&, double f) { return f < 0.5; }),
                Cancelled);
  EXPECT_EQ (folder.entries (), 0u);
  SequenceOptions options;
  options.first = 7;
  EXPECT_THROW (writeSequence (scene, folder.file ("out"), options), InvalidArgument);
  EXPECT_EQ (folder.entries (), 0u);
  fs::create_directory (folder.file ("empty"));
  options.first = 6;
  writeSequence (scene, folder.file ("empty"), options);
  EXPECT_THROW (writeSequence (scene, folder.file ("empty"), options), IoError); // not empty any more
  std::ofstream (folder.file ("file")) << "x";
  EXPECT_THROW (writeSequence (scene, folder.file ("file"), options), IoError);
  EXPECT_THROW (writeSequence (scene, folder.file ("file/out"), options), IoError);
  EXPECT_EQ (folder.entries (), 2u);
}
