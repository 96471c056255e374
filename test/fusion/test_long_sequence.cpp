// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// A sequence may go on for as long as it likes: what is remembered of it is bounded.

#include "ball_and_box.h"
#include "io/sequence_folder.h"

#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/fusion/sequence_fusion.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace {

const char* const walls = R"({"type": "room", "size": [2, 2, 1.5], "position": [0, 0, 0.75]},
    {"type": "box", "size": [0.3, 0.3, 0.3], "position": [0.4, 0.5, 0.15], "rpy_deg": [0, 0, 20]})";

constexpr int rendered = 12;
constexpr int played = 900;
constexpr int mask_every = 10;

/** \brief To and fro through what was rendered. */
std::string
renderedName (int n)
{
  const int lap = 2 * (rendered - 1);
  return SequenceFolder::fourDigits (std::min (n % lap, lap - n % lap)) + ".png";
}

/** \brief What the process has allocated. Its resident memory also has gaps between blocks, which threads leave by
 * chance. */
std::size_t
allocatedBytes ()
{
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 info = ::mallinfo2 ();
  return info.uordblks + info.hblkhd;
#else
  std::size_t all = 0;
  std::size_t resident = 0;
  std::ifstream ("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t> (::sysconf (_SC_PAGESIZE));
#endif
}

FusionOptions
smallOptions ()
{
  FusionOptions options;
  options.front_end.background_resolution = 96;
  options.front_end.object_resolution = 24;
  options.backend.max_views = 16;
  options.backend.max_keyframes = 4;
  options.backend.method.resolution = 16;
  options.backend.method.background_voxel_size_m = 0.05;
  options.updates = KeyframeUpdates::Beside;
  options.keyframe_every = 70;
  return options;
}

} // namespace

TEST (LongSequence, MemoryDoesNotGrowWithItsLength)
{
  const SequenceFolder folder;
  writeSequence (parseSceneSpec (sceneJson (rendered, 160, 120, 0.4, walls), "scene"), folder.path ("rendered"));
  fs::copy_file (folder.path ("rendered/calibration.txt"), folder.newPath ("long/calibration.txt"));
  for (int n = 0; n < played; ++n)
  {
    const std::string name = SequenceFolder::fourDigits (n) + ".png";
    fs::create_symlink (folder.path ("rendered/depth_noise/Depth" + renderedName (n)),
                        folder.newPath ("long/depth/Depth" + name));
    if (n % mask_every == 0)
      fs::create_symlink (folder.path ("rendered/mask/Mask" + renderedName (n)),
                          folder.newPath ("long/mask/Mask" + name));
  }
  const RgbdSequence images (folder.path ("long"));
  const MaskSequence masks (folder.path ("long/mask"), images);

  // the least of some frames, as an update of the objects takes memory while it runs
  constexpr int watched = 60;
  std::size_t after_a_third = std::numeric_limits<std::size_t>::max (), in_the_end = after_a_third;
  int frame = 0;
  const auto watch = [&] (const std::string&, double) {
    if (frame >= played / 3 && frame < played / 3 + watched && frame % mask_every == 0)
      after_a_third = std::min (after_a_third, allocatedBytes ());
    if (frame >= played - watched && frame < played && frame % mask_every == 0)
      in_the_end = std::min (in_the_end, allocatedBytes ());
    ++frame;
    return true;
  };
  std::size_t updates = 0;
  const FusionResult result = SequenceFusion (TrackedSequence (images, &masks), smallOptions ())
                                  .run (watch, [&] (const KeyframeReport&) { ++updates; });

  EXPECT_EQ (result.frames, static_cast<std::size_t> (played));
  EXPECT_LE (result.kept_keyframes, 4u);
  EXPECT_GE (updates, 1u);
  EXPECT_LE (updates, result.keyframes);
  ASSERT_EQ (result.scene.objects.size (), 2u);
  for (const ObjectResult& object : result.scene.objects)
    EXPECT_EQ (object.error, "");
  constexpr std::size_t image = 160 * 120 * sizeof (float);
  EXPECT_LT (in_the_end, after_a_third + 90 * image) << "of the 540 frames between";
}
