// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "io/sequence_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <gtest/gtest.h>

#include <numeric>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

std::vector<int>
firstNumbers (int count)
{
  std::vector<int> numbers (static_cast<std::size_t> (count));
  std::iota (numbers.begin (), numbers.end (), 0);
  return numbers;
}

} // namespace

TEST (FrameReader, GivesWhatTheSequenceGives)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (20));
  const RgbdSequence sequence (folder.path ());
  for (const std::size_t ahead : {1, 2, 4, 100})
  {
    FrameReader reader (sequence, {}, ahead);
    for (std::size_t n = 0; n < 20; ++n)
    {
      const std::optional<RgbdFrame> frame = reader.next ();
      ASSERT_TRUE (frame);
      EXPECT_EQ (frame->index, n);
      std::vector<std::string> ignored;
      const RgbdFrame expected = sequence.read (n, ignored);
      expectSameDepth (expected.depth, frame->depth, 0.0);
      EXPECT_EQ (frame->colour.pixels, expected.colour.pixels);
    }
    EXPECT_FALSE (reader.next ());
    EXPECT_FALSE (reader.next ());
    EXPECT_TRUE (reader.warnings ().empty ());
    EXPECT_EQ (reader.skipped (), 0u);
  }
}

TEST (FrameReader, ReadsARange)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (5));
  const RgbdSequence sequence (folder.path ());
  FrameReader reader (sequence, {1, 3});
  EXPECT_EQ (reader.next ()->index, 1u);
  EXPECT_EQ (reader.next ()->index, 2u);
  EXPECT_FALSE (reader.next ());
  FrameReader rest (sequence, {4, 1000});
  EXPECT_EQ (rest.next ()->index, 4u);
  EXPECT_FALSE (rest.next ());
  EXPECT_NE (messageOf<InvalidArgument> ([&] { FrameReader (sequence, {5, 9}); }).find ("0:5"), std::string::npos);
  EXPECT_THROW (FrameReader (sequence, {3, 3}), InvalidArgument);
  EXPECT_THROW (FrameReader (sequence, {}, 0), InvalidArgument);
}

TEST (FrameReader, SkipsAndTellsWhatCannotBeRead)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (8));
  folder.text ("depth/Depth0000.png", "no image");
  folder.depth ("depth/Depth0003.png", 3, 1000.0, 2, 2);
  folder.text ("colour/Color0005.png", "no image");
  const RgbdSequence sequence (folder.path ());
  fs::remove (folder.path ("depth/Depth0007.png"));
  for (int repeat = 0; repeat < 20; ++repeat)
  {
    FrameReader reader (sequence);
    std::vector<std::size_t> told; // after each frame, whatever was read ahead
    std::vector<std::size_t> indices;
    while (const std::optional<RgbdFrame> frame = reader.next ())
    {
      indices.push_back (frame->index);
      told.push_back (reader.warnings ().size ());
    }
    EXPECT_EQ (indices, (std::vector<std::size_t>{1, 2, 4, 5, 6}));
    EXPECT_EQ (told, (std::vector<std::size_t>{1, 1, 2, 3, 3}));
    EXPECT_EQ (reader.skipped (), 3u);
    const std::vector<std::string> warnings = reader.warnings ();
    ASSERT_EQ (warnings.size (), 4u);
    const char* names[] = {"Depth0000.png", "Depth0003.png", "Color0005.png", "Depth0007.png"};
    for (std::size_t n = 0; n < 4; ++n)
      EXPECT_NE (warnings[n].find (names[n]), std::string::npos) << warnings[n];
  }
}

TEST (FrameReader, CountsWarningsBeyondTheFirstTwenty)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (50));
  const RgbdSequence sequence (folder.path ());
  fs::remove_all (folder.path ("depth"));
  FrameReader reader (sequence);
  EXPECT_FALSE (reader.next ());
  EXPECT_EQ (reader.skipped (), 50u);
  const std::vector<std::string> warnings = reader.warnings ();
  ASSERT_EQ (warnings.size (), 21u);
  EXPECT_EQ (warnings.back (), "and 30 more warnings about frames");
  FrameReader of_some (sequence, {0, 21});
  EXPECT_FALSE (of_some.next ());
  EXPECT_EQ (of_some.warnings ().back (), "and 1 more warning about frames");
}

TEST (FrameReader, StopsAtAnyTime)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (12));
  const RgbdSequence sequence (folder.path ());
  for (int taken = 0; taken <= 12; ++taken)
    for (const std::size_t ahead : {1, 4})
    {
      FrameReader reader (sequence, {}, ahead);
      for (int n = 0; n < taken; ++n)
        EXPECT_TRUE (reader.next ());
    }
}

TEST (FrameReader, OutlivesTheSequence)
{
  SequenceFolder folder;
  folder.coFusion (firstNumbers (6));
  auto sequence = std::make_unique<RgbdSequence> (folder.path ());
  FrameReader reader (*sequence, {}, 1);
  sequence.reset ();
  std::size_t count = 0;
  while (reader.next ())
    ++count;
  EXPECT_EQ (count, 6u);
}
