// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Decoding of the output arrays of networks, without a network.

#include <pcl/cosection/segmentation/instance_detector.h>

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numeric>

using namespace pcl::cosection;

namespace {

constexpr int image_width = 64, image_height = 48;
const ImagePlacement same_size (image_width, image_height, image_width, image_height, false);

NetworkOutput
output (const std::string& name, const std::vector<int>& shape, float value = 0.0f)
{
  const int count = std::accumulate (shape.begin (), shape.end (), 1, std::multiplies<> ());
  return {name, shape, std::vector<float> (static_cast<std::size_t> (count), value)};
}

/** \brief One-stage outputs: 3 classes, and 2 prototypes: a full mask and an empty one. */
std::vector<NetworkOutput>
oneStage (int candidates)
{
  std::vector<NetworkOutput> outputs = {output ("proposals", {1, 9, candidates}),
                                        output ("prototypes", {1, 2, 12, 16}, 8.0f)};
  std::fill (outputs[1].values.begin () + 12 * 16, outputs[1].values.end (), -8.0f);
  return (outputs);
}

struct Proposal
{
  float x, y, width, height;
  int class_id;
  float score;
  bool empty; ///< the mask is
};

void
set (NetworkOutput& proposals, std::size_t n, const Proposal& p)
{
  const auto count = static_cast<std::size_t> (proposals.shape[2]);
  const std::array<float, 4> box = {p.x, p.y, p.width, p.height};
  for (std::size_t k = 0; k < 4; ++k)
    proposals.values[k * count + n] = box[k];
  proposals.values[(4 + static_cast<std::size_t> (p.class_id)) * count + n] = p.score;
  proposals.values[(p.empty ? 8 : 7) * count + n] = 1.0f;
}

std::size_t
pixels (const DetectedInstance& instance)
{
  return (static_cast<std::size_t> (std::count (instance.mask.pixels.begin (), instance.mask.pixels.end (), 1)));
}

} // namespace

TEST (NetworkOutputs, OverlappingCandidatesOfAClassAreOne)
{
  std::vector<NetworkOutput> outputs = oneStage (20);
  set (outputs[0], 3, {20, 20, 10, 8, 1, 0.7f, false});
  set (outputs[0], 4, {21, 20, 10, 8, 1, 0.8f, false}); // the same, and better
  set (outputs[0], 5, {21, 20, 10, 8, 2, 0.6f, false}); // another class
  set (outputs[0], 6, {40, 20, 10, 8, 1, 0.9f, false}); // elsewhere
  set (outputs[0], 7, {40, 40, 10, 8, 1, 0.4f, false}); // not believed
  set (outputs[0], 8, {10, 40, 10, 8, 1, 0.9f, true});  // no mask
  const std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 3u);
  EXPECT_EQ (found[0].score, 0.9f);
  EXPECT_EQ (found[0].left, 35);
  EXPECT_EQ (found[0].top, 16);
  EXPECT_EQ (found[0].mask.width, 10);
  EXPECT_EQ (pixels (found[0]), 80u);
  EXPECT_EQ (found[1].score, 0.8f);
  EXPECT_EQ (found[1].left, 16);
  EXPECT_EQ (found[2].class_id, 2);
  EXPECT_EQ (found[2].class_name, "2");
  InstanceDecodingOptions one;
  one.max_instances = 1;
  EXPECT_EQ (decodeInstances (outputs, same_size, one).size (), 1u);
}

TEST (NetworkOutputs, CandidatesMayStandInRows)
{
  constexpr int count = 20;
  std::vector<NetworkOutput> outputs = {output ("proposals", {1, count, 10}), oneStage (1)[1]};
  const std::vector<float> candidate = {20, 20, 10, 8, 0.8f, 0, 0.9f, 0, 1, 0}; // a score before the classes'
  std::copy (candidate.begin (), candidate.end (), outputs[0].values.begin () + 30);
  const std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (found[0].class_id, 1);
  EXPECT_FLOAT_EQ (found[0].score, 0.72f);
  EXPECT_EQ (pixels (found[0]), 80u);
}

TEST (NetworkOutputs, MasksAreInterpolatedBetweenTheMiddlesOfCells)
{
  // A ramp of 4 cells over 32 pixels: the middles of cells are at 4, 12, 20, 28; 0.5 is reached at 16.
  std::vector<NetworkOutput> outputs = {output ("boxes", {1, 4}), output ("labels", {1}, 1.0f),
                                        output ("scores", {1}, 1.0f), output ("masks", {1, 1, 1, 4})};
  outputs[0].values = {8, 8, 40, 16};
  outputs[3].values = {0.125f, 0.375f, 0.625f, 0.875f};
  const std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (found[0].left, 8);
  ASSERT_EQ (found[0].mask.width, 32);
  for (int u = 0; u < 32; ++u)
    EXPECT_EQ (found[0].mask.at (u, 3), u + 0.5 > 16.0 ? 1 : 0) << u;
  InstanceDecodingOptions options;
  options.mask_threshold = 0.3;
  EXPECT_GT (pixels (decodeInstances (outputs, same_size, options)[0]), pixels (found[0]));
}

TEST (NetworkOutputs, MasksMayCoverTheInput)
{
  std::vector<NetworkOutput> outputs = {output ("1", {1, 4}), output ("2", {1}, 1.0f), output ("3", {1}, 1.0f),
                                        output ("4", {1, 1, image_height, image_width})};
  outputs[0].values = {10, 10, 20, 20};
  for (int v = 0; v < image_height; ++v)
    for (int u = 0; u < 14; ++u)
      outputs[3].values[static_cast<std::size_t> (v * image_width + u)] = 1.0f;
  const std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (pixels (found[0]), 4u * 10u);
}

TEST (NetworkOutputs, NamesTellLabelsFromScores)
{
  std::vector<NetworkOutput> outputs = {output ("boxes", {1, 4}), output ("masks", {1, 1, 2, 2}, 1.0f),
                                        output ("scores", {1, 1}, 0.75f), output ("labels", {1, 1}, 5.0f)};
  outputs[0].values = {0, 0, 8, 8};
  EXPECT_EQ (outputForm (outputs), NetworkOutputForm::BoxList);
  const std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (found[0].class_id, 5);
  EXPECT_EQ (found[0].score, 0.75f);
}

TEST (NetworkOutputs, NothingFoundIsNoError)
{
  EXPECT_TRUE (decodeInstances ({output ("d", {1, 1, 0, 7}), output ("m", {0, 90, 15, 15})}, same_size).empty ());
  EXPECT_TRUE (decodeInstances ({output ("d", {1, 1, 100, 7}), output ("m", {100, 90, 2, 2})}, same_size).empty ());
  EXPECT_TRUE (
      decodeInstances ({output ("b", {0, 4}), output ("l", {0}), output ("s", {0}), output ("m", {0, 1, 28, 28})},
                       same_size)
          .empty ());
  EXPECT_TRUE (decodeInstances (oneStage (100), same_size).empty ());
}

TEST (NetworkOutputs, WhatIsOutsideOrNotFiniteIsLeftOut)
{
  const float nan = std::numeric_limits<float>::quiet_NaN (), inf = std::numeric_limits<float>::infinity ();
  std::vector<NetworkOutput> outputs = oneStage (20);
  set (outputs[0], 0, {nan, 20, 10, 8, 1, 0.9f, false});
  set (outputs[0], 1, {20, inf, 10, 8, 1, 0.9f, false});
  set (outputs[0], 2, {20, 20, -10, 8, 1, 0.9f, false});
  set (outputs[0], 3, {20, 20, 0, 8, 1, 0.9f, false});
  set (outputs[0], 4, {-50, 20, 10, 8, 1, 0.9f, false});
  set (outputs[0], 5, {20, 20, 10, 8, 1, nan, false});
  set (outputs[0], 6, {20, 20, 10, 8, 1, inf, false});
  set (outputs[0], 7, {1e30f, 1e30f, 8, 8, 1, 0.9f, false});
  for (const DetectedInstance& instance : decodeInstances (outputs, same_size))
    ADD_FAILURE () << instance.left << ' ' << instance.top << ' ' << instance.mask.width << ' ' << instance.mask.height;

  outputs = oneStage (20);
  set (outputs[0], 0, {0, 0, 1e30f, 1e30f, 1, 0.9f, false}); // larger than the image: as far as it is in it
  std::vector<DetectedInstance> found = decodeInstances (outputs, same_size);
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (pixels (found[0]), static_cast<std::size_t> (image_width * image_height));
  std::fill (outputs[1].values.begin (), outputs[1].values.end (), nan);
  EXPECT_TRUE (decodeInstances (outputs, same_size).empty ());
}

TEST (NetworkOutputs, OfNoKnownFormIsAnError)
{
  const auto refused = [] (const std::vector<NetworkOutput>& outputs) {
    EXPECT_THROW (outputForm (outputs), InvalidArgument);
  };
  refused ({});
  refused ({output ("boxes", {1, 84, 8400})});                          // no masks
  refused ({output ("a", {1, 36, 100}), output ("b", {1, 32, 8, 8})});  // no class
  refused ({output ("a", {1, 36, 100}), output ("b", {1, 0, 8, 8})});   // no prototype
  refused ({output ("a", {2, 116, 100}), output ("b", {2, 32, 8, 8})}); // two images
  refused ({output ("a", {1, 1, 5, 7}), output ("b", {4, 9, 8, 8})});   // fewer masks
  refused ({output ("a", {5, 4}), output ("b", {5}), output ("c", {4}), output ("d", {5, 1, 8, 8})});
  std::vector<NetworkOutput> outputs = oneStage (20);
  outputs[0].values.pop_back (); // not what the shape says
  refused (outputs);
  outputs[0].shape = {1, -9, -20};
  refused (outputs);
}

TEST (NetworkOutputs, RefusesWhatDoesNotFit)
{
  InstanceDecodingOptions options;
  options.class_names = {"cup", "bottle"};
  EXPECT_THROW (decodeInstances (oneStage (20), same_size, options), InvalidArgument);
  options.class_names.emplace_back ("plate");
  EXPECT_NO_THROW (decodeInstances (oneStage (20), same_size, options));
  options.mask_threshold = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (decodeInstances (oneStage (20), same_size, options), InvalidArgument);
  EXPECT_THROW (ImagePlacement (0, 10, 10, 10, true), InvalidArgument);
}

TEST (NetworkOutputs, ALetterboxHasTheImageInItsMiddle)
{
  const ImagePlacement wide (640, 360, 320, 320, true);
  EXPECT_EQ (wide.left, 0);
  EXPECT_EQ (wide.top, 70);
  EXPECT_EQ (wide.width, 320);
  EXPECT_EQ (wide.height, 180);
  const ImagePlacement high (100, 1000, 320, 320, true);
  EXPECT_EQ (high.left, 144);
  EXPECT_EQ (high.width, 32);
  EXPECT_EQ (ImagePlacement (100000, 1, 320, 320, true).height, 1);
  const ImagePlacement stretched (640, 360, 320, 320, false);
  EXPECT_EQ (stretched.height, 320);
}
