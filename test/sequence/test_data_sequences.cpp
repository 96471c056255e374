// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Sequences of real and simulated cameras.

#include "common/data_folder.h"

#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Points of the world that a frame shows, every \a step pixels. */
std::vector<Eigen::Vector3d>
worldPoints (const RgbdSequence& sequence, std::size_t index, const Eigen::Isometry3d& T_world_camera, int step)
{
  std::vector<std::string> ignored;
  const Image<float> depth = sequence.read (index, ignored).depth;
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < depth.height; v += step)
    for (int u = 0; u < depth.width; u += step)
      if (const float z = depth.at (u, v); std::isfinite (z))
        points.push_back (T_world_camera * sequence.camera ().unproject (u, v, z));
  return points;
}

/** \brief The share of the points of one frame, of those in view of another, that the other sees at their depth. It is
 * near 1 only if intrinsics, depth scale and poses fit together. */
double
agreement (const RgbdSequence& sequence, const std::vector<std::optional<Eigen::Isometry3d>>& poses, std::size_t first,
           std::size_t second)
{
  std::vector<std::string> ignored;
  const Image<float> depth = sequence.read (second, ignored).depth;
  const PinholeCamera& camera = sequence.camera ();
  double seen = 0.0, agree = 0.0;
  for (const Eigen::Vector3d& p_world : worldPoints (sequence, first, *poses[first], 8))
  {
    const Eigen::Vector3d p = poses[second]->inverse () * p_world;
    if (p.z () < 0.3)
      continue;
    const Eigen::Vector2d pixel = camera.project (p);
    const int u = static_cast<int> (std::lround (pixel.x ())), v = static_cast<int> (std::lround (pixel.y ()));
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height || !std::isfinite (depth.at (u, v)))
      continue;
    seen += 1.0;
    agree += std::abs (depth.at (u, v) - p.z ()) < 0.03 * p.z ();
  }
  EXPECT_GT (seen, 500.0);
  return agree / seen;
}

} // namespace

class DataSequence : public testing::TestWithParam<std::tuple<const char*, SequenceFormat, std::size_t, int>>
{};

TEST_P (DataSequence, EveryFrameIsRead)
{
  const auto [name, format, count, width] = GetParam ();
  if (!fs::exists (dataFolder (name)))
    GTEST_SKIP () << dataFolder (name).string () << " is not there";
  const RgbdSequence sequence (dataFolder (name).string ());
  EXPECT_EQ (sequence.format (), format);
  EXPECT_EQ (sequence.size (), count);
  EXPECT_EQ (sequence.camera ().width, width);
  EXPECT_TRUE (sequence.warnings ().empty ()) << sequence.warnings ()[0];
  FrameReader reader (sequence);
  std::size_t read = 0;
  while (const std::optional<RgbdFrame> frame = reader.next ())
  {
    EXPECT_EQ (frame->index, read++);
    EXPECT_EQ (frame->colour.width, width);
    EXPECT_EQ (frame->colour.height, frame->depth.height);
  }
  EXPECT_EQ (read, count);
  EXPECT_TRUE (reader.warnings ().empty ()) << reader.warnings ()[0];
}

INSTANTIATE_TEST_SUITE_P (All, DataSequence,
                          testing::Values (std::tuple ("toycars", SequenceFormat::CoFusion, 100, 640),
                                           std::tuple ("kitchen", SequenceFormat::Tum, 120, 640),
                                           std::tuple ("hands", SequenceFormat::Tum, 300, 320)));

TEST (DataSequences, CameraPosesBringFramesTogether)
{
  for (const auto& [name, trajectory] :
       {std::pair ("toycars", "gt-cam-0.txt"), std::pair ("kitchen", "groundtruth.txt")})
  {
    if (!fs::exists (dataFolder (name)))
      GTEST_SKIP () << dataFolder (name).string () << " is not there";
    const RgbdSequence sequence (dataFolder (name).string ());
    const auto poses = posesAtStamps (loadTrajectory ((dataFolder (name) / trajectory).string ()), sequence.stamps (),
                                      sequence.period ());
    for (const auto& pose : poses)
      ASSERT_TRUE (pose);
    EXPECT_GT (agreement (sequence, poses, 10, 40), 0.8) << name;
  }
}

TEST (DataSequences, MasksShowWhatStandsOutFromTheFloor)
{
  const std::string folder = dataFolder ("toycars").string ();
  if (!fs::exists (folder))
    GTEST_SKIP () << folder << " is not there";
  const RgbdSequence sequence (folder);
  const MaskSequence masks (folder + "/mask", sequence);
  EXPECT_EQ (masks.size (), sequence.size ());
  EXPECT_TRUE (masks.warnings ().empty ());
  const auto poses = posesAtStamps (loadTrajectory (folder + "/gt-cam-0.txt"), sequence.stamps (), sequence.period ());
  std::set<int> ids;
  for (const std::size_t n : {0, 50, 99})
  {
    std::vector<std::string> ignored;
    const Image<float> depth = sequence.read (n, ignored).depth;
    const auto mask = masks.read (sequence.stamp (n));
    ASSERT_TRUE (mask);
    double objects = 0.0, below_floor = 0.0;
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width; ++u)
        if (const int id = mask->at (u, v); id != 0 && std::isfinite (depth.at (u, v)))
        {
          ids.insert (id);
          objects += 1.0;
          below_floor += (*poses[n] * sequence.camera ().unproject (u, v, depth.at (u, v))).z () < -0.02;
        }
    EXPECT_GT (objects, 1000.0);
    EXPECT_LT (below_floor, 0.01 * objects);
  }
  EXPECT_EQ (ids, (std::set<int>{1, 2, 3}));
}
