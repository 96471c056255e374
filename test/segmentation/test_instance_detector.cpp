// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Networks that the tests create, run by OpenCV.

#include <pcl/cosection/segmentation/instance_detector.h>

#include "common/message_of.h"
#include "common/temporary_folder.h"
#include "spot_network.h"

#include <pcl/cosection/common/error.h>

#include <opencv2/core/utility.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>

using namespace pcl::cosection;
using test::SpotNetwork;

namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour red = {255, 0, 0}, blue = {0, 0, 255};

class Detector : public testing::TestWithParam<NetworkOutputForm>
{
protected:
  InstanceDetectorOptions write (const std::string& name, const std::string& bytes) const
  {
    std::ofstream (folder_.file (name), std::ios::binary) << bytes;
    InstanceDetectorOptions options;
    options.model = folder_.file (name);
    return (options);
  }

  /** \brief Options of a network that finds spots. */
  InstanceDetectorOptions spotNetwork (NetworkOutputForm form, float brightest = 255.0f, bool fixed_size = true) const
  {
    if (form != NetworkOutputForm::DetectionOut)
      brightest /= 255.0f;
    InstanceDetectorOptions options = write (
        "spot.onnx",
        affineOnnx (SpotNetwork::width, SpotNetwork::height, SpotNetwork{form, brightest}.outputs (), fixed_size));
    options.input_width = SpotNetwork::width;
    options.input_height = SpotNetwork::height;
    return (options);
  }

  std::string failure (const InstanceDetectorOptions& options, const Picture& picture = test::spotPicture (0, 0)) const
  {
    return (test::messageOf<Error> ([&] { InstanceDetector (options).detect (picture); }));
  }

  const test::TemporaryFolder folder_;
};

/** \brief Mask of an instance in the picture. */
Image<std::uint8_t>
inPicture (const DetectedInstance& instance, const Picture& picture)
{
  Image<std::uint8_t> mask (picture.width, picture.height, 0);
  for (int v = 0; v < instance.mask.height; ++v)
    for (int u = 0; u < instance.mask.width; ++u)
      mask.at (instance.left + u, instance.top + v) = instance.mask.at (u, v);
  return (mask);
}

/** \brief The spot, or its left half. */
Image<std::uint8_t>
expectedMask (const Picture& picture, bool left_half)
{
  Image<std::uint8_t> mask (picture.width, picture.height, 0);
  for (int v = 0; v < picture.height; ++v)
  {
    int first = 0, count = 0;
    for (int u = 0; u < picture.width; ++u)
      if (picture.at (u, v) != Colour{0, 0, 0} && count++ == 0)
        first = u;
    for (int u = first; u < first + (left_half ? count / 2 : count); ++u)
      mask.at (u, v) = 1;
  }
  return (mask);
}

void
expectSpot (const std::vector<DetectedInstance>& found, const Picture& picture, NetworkOutputForm form)
{
  ASSERT_EQ (found.size (), 1u);
  EXPECT_EQ (found[0].class_id, 2);
  EXPECT_NEAR (found[0].score, 0.9, 1e-5);
  const bool is_spot = form == NetworkOutputForm::Prototypes;
  const std::vector<std::uint8_t> mask = inPicture (found[0], picture).pixels,
                                  expected = expectedMask (picture, !is_spot).pixels;
  const double wrong = std::inner_product (mask.begin (), mask.end (), expected.begin (), 0.0, std::plus<> (),
                                           std::not_equal_to<> ());
  const double pixels = std::accumulate (expected.begin (), expected.end (), 0.0);
  EXPECT_LE (wrong, is_spot ? 0.08 * pixels : 0.0); // interpolation between few cells rounds corners
}

} // namespace

TEST_P (Detector, FindsTheSpotWhereItIs)
{
  InstanceDetectorOptions options = spotNetwork (GetParam ());
  options.letterbox = false;
  options.detection.class_names = {"plate", "cup", "bottle"};
  InstanceDetector detector (options);
  for (const int enlarged : {1, 2, 4})
    for (const auto& [left, top] : {std::pair (0, 0), std::pair (8, 6), std::pair (18, 12)})
    {
      const Picture picture = test::spotPicture (left, top, red, enlarged);
      const std::vector<DetectedInstance> found = detector.detect (picture);
      expectSpot (found, picture, GetParam ());
      EXPECT_EQ (found.at (0).class_name, "bottle");
    }
}

TEST_P (Detector, KeepsProportionsWithALetterbox)
{
  constexpr std::uint8_t grey = 114; // of the margins
  InstanceDetectorOptions options = spotNetwork (GetParam (), 255 - grey);
  options.letterbox = true;
  options.mean.fill (grey);
  InstanceDetector detector (options);
  for (const int enlarged : {1, 2})
    for (const auto& [left, top] : {std::pair (0, 0), std::pair (10, 2), std::pair (18, 4)})
    {
      const Picture picture = test::spotPicture (left, top, red, enlarged, SpotNetwork::width, SpotNetwork::height / 2);
      Picture on_grey = picture;
      std::replace (on_grey.pixels.begin (), on_grey.pixels.end (), Colour{0, 0, 0}, Colour{grey, grey, grey});
      expectSpot (detector.detect (on_grey), picture, GetParam ());
    }
}

TEST_P (Detector, FindsNothingInADarkPicture)
{
  InstanceDetectorOptions options = spotNetwork (GetParam ());
  options.letterbox = false;
  options.detection.score_threshold = 0.95;
  EXPECT_TRUE (InstanceDetector (options).detect (test::spotPicture (4, 4)).empty ());
}

TEST_P (Detector, AsksForTheSizeThatTheFileFixes)
{
  InstanceDetectorOptions options = spotNetwork (GetParam ());
  options.input_width = options.input_height = 0;
  EXPECT_NE (failure (options, test::spotPicture (8, 6, red, 4)).find ("give --input-size W,H"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P (Forms, Detector,
                          testing::Values (NetworkOutputForm::DetectionOut, NetworkOutputForm::BoxList,
                                           NetworkOutputForm::Prototypes));

TEST_F (Detector, TakesTheImagesSizeUnlessItIsAOneStageNetwork)
{
  for (const NetworkOutputForm form : {NetworkOutputForm::DetectionOut, NetworkOutputForm::BoxList})
  {
    InstanceDetectorOptions options = spotNetwork (form, 255.0f, false);
    options.input_width = options.input_height = 0;
    const Picture picture = test::spotPicture (2, 4);
    expectSpot (InstanceDetector (options).detect (picture), picture, form);
  }
  InstanceDetectorOptions options = spotNetwork (NetworkOutputForm::Prototypes, 255.0f, false);
  options.input_width = options.input_height = 0;
  EXPECT_NE (failure (options).find ("640 x 640"), std::string::npos);
}

TEST_F (Detector, ReadsANetworkAnewForEachSize)
{
  InstanceDetectorOptions options = spotNetwork (NetworkOutputForm::BoxList, 255.0f, false);
  options.input_width = options.input_height = 0;
  InstanceDetector detector (options);
  const Picture picture = test::spotPicture (2, 4);
  expectSpot (detector.detect (picture), picture, NetworkOutputForm::BoxList);
  EXPECT_THROW (detector.detect (Picture (7, 5, red)), IoError); // its products are of one size
  expectSpot (detector.detect (picture), picture, NetworkOutputForm::BoxList);
}

TEST_F (Detector, OutputsThatTheImporterLeavesOutStopNothing)
{
  for (const bool is_constant : {true, false})
  {
    InstanceDetectorOptions options = spotNetwork (NetworkOutputForm::BoxList, 255.0f, false);
    OnnxGraph more; // the parts of a file may follow each other
    more.output ("more", {2});
    if (is_constant)
      more.integers ("more", {1, 2});
    std::ofstream (options.model, std::ios::binary | std::ios::app) << more.bytes ();
    InstanceDetector detector (options);
    const Picture picture = test::spotPicture (2, 4);
    for (int time = 0; time < 2; ++time)
      expectSpot (detector.detect (picture), picture, NetworkOutputForm::BoxList);
  }
}

TEST_F (Detector, TakesRedOrBlueFirst)
{
  InstanceDetectorOptions options = spotNetwork (NetworkOutputForm::Prototypes);
  const Picture red_spot = test::spotPicture (4, 4, red), blue_spot = test::spotPicture (4, 4, blue);
  EXPECT_EQ (InstanceDetector (options).detect (red_spot).size (), 1u);
  EXPECT_EQ (InstanceDetector (options).detect (blue_spot).size (), 0u);
  options.blue_first = true;
  EXPECT_EQ (InstanceDetector (options).detect (red_spot).size (), 0u);
  EXPECT_EQ (InstanceDetector (options).detect (blue_spot).size (), 1u);
}

TEST_F (Detector, SubtractsTheMeanAndScales)
{
  const Colour colour = {200, 120, 90};
  const std::array<double, 3> mean = {50.0, 20.0, 10.0};
  for (const bool blue_first : {false, true})
    for (int channel = 0; channel < 3; ++channel)
    {
      std::vector<test::AffineOutput> outputs = SpotNetwork{NetworkOutputForm::BoxList}.outputs ();
      outputs[0].weights.setZero ();
      outputs[0].bias << 0, 0, 8, 8;
      outputs[2].weights (0, channel * SpotNetwork::width * SpotNetwork::height) = 1.0f; // the first pixel is the score
      outputs[2].bias.setZero ();
      InstanceDetectorOptions options = write ("score.onnx",
                                               affineOnnx (SpotNetwork::width, SpotNetwork::height, outputs));
      options.mean = mean;
      options.scale = 0.005;
      options.blue_first = blue_first;
      options.detection.score_threshold = 0.1;
      const Picture picture (SpotNetwork::width, SpotNetwork::height, colour);
      const auto found = InstanceDetector (options).detect (picture);
      ASSERT_EQ (found.size (), 1u);
      const std::size_t c = blue_first ? 2 - channel : channel;
      EXPECT_NEAR (found[0].score, 0.005 * (colour[c] - mean[c]), 1e-6);
    }
}

TEST_F (Detector, DoesNotDependOnThreads)
{
  const Picture picture = test::spotPicture (4, 4);
  const int before = cv::getNumThreads ();
  std::vector<float> scores;
  for (const int threads : {1, 2})
  {
    cv::setNumThreads (threads);
    scores.push_back (InstanceDetector (spotNetwork (NetworkOutputForm::Prototypes)).detect (picture).at (0).score);
    EXPECT_EQ (cv::getNumThreads (), threads);
  }
  cv::setNumThreads (before);
  EXPECT_EQ (scores[0], scores[1]);
}

TEST_F (Detector, ReadsTensorFlow)
{
  const SpotNetwork network{NetworkOutputForm::BoxList};
  std::vector<test::AffineOutput> outputs = network.outputs ();
  outputs[3].shape.erase (outputs[3].shape.begin ());
  const InstanceDetectorOptions options = write ("spot.pb",
                                                 affineTensorflow (SpotNetwork::width, SpotNetwork::height, outputs));
  const Picture picture = test::spotPicture (8, 6);
  expectSpot (InstanceDetector (options).detect (picture), picture, network.form);
}

TEST_F (Detector, SaysWhatIsWrongWithAModel)
{
  const std::string good = affineOnnx (SpotNetwork::width, SpotNetwork::height,
                                       SpotNetwork{NetworkOutputForm::BoxList}.outputs ());
  InstanceDetectorOptions options;
  EXPECT_NE (failure (options).find (".onnx"), std::string::npos);
  options.model = "model.pt";
  EXPECT_NE (failure (options).find ("model.pt"), std::string::npos);
  options.model = folder_.file ("absent.onnx");
  EXPECT_NE (failure (options).find ("absent.onnx"), std::string::npos);
  for (const char* const name : {"bad.onnx", "bad.pb"})
    for (const std::string& bytes :
         {std::string (), std::string ("no network\n"), good.substr (0, good.size () / 2), good.substr (0, 60)})
      EXPECT_EQ (failure (write (name, bytes)).find (folder_.file (name)), 0u) << name << ' ' << bytes.size ();
  options = write ("good.onnx", good);
  options.config = "graph.pbtxt";
  EXPECT_NE (failure (options).find ("graph.pbtxt"), std::string::npos);
  options.model = write ("spot.pb", "").model;
  options.config = folder_.file ("absent.pbtxt");
  EXPECT_NE (failure (options).find ("absent.pbtxt"), std::string::npos);
}

TEST_F (Detector, SaysWhatIsWrongWithTheOutputs)
{
  std::vector<test::AffineOutput> outputs = SpotNetwork{NetworkOutputForm::BoxList}.outputs ();
  outputs.pop_back ();
  InstanceDetectorOptions options = write ("boxes.onnx", affineOnnx (SpotNetwork::width, SpotNetwork::height, outputs));
  options.input_width = SpotNetwork::width;
  options.input_height = SpotNetwork::height;
  const std::string message = failure (options);
  EXPECT_EQ (message.find (options.model), 0u);
  EXPECT_NE (message.find ("boxes [1 x 4]"), std::string::npos) << message;
  EXPECT_NE (message.find ("masks [N x 1 x h x w]"), std::string::npos) << message;

  options = spotNetwork (NetworkOutputForm::Prototypes);
  options.detection.class_names = {"cup", "bottle"};
  EXPECT_NE (failure (options).find ("3 classes"), std::string::npos);
  EXPECT_NE (failure (spotNetwork (NetworkOutputForm::BoxList), Picture ()).find ("pixels"), std::string::npos);
}

TEST_F (Detector, RefusesParametersOutsideTheirDomain)
{
  const InstanceDetectorOptions good = spotNetwork (NetworkOutputForm::BoxList);
  const auto refused = [&] (auto change) {
    InstanceDetectorOptions options = good;
    change (options);
    EXPECT_THROW (InstanceDetector detector (options), InvalidArgument);
  };
  refused ([] (auto& options) { options.input_width = 0; });
  refused ([] (auto& options) { options.input_height = 1000000; });
  refused ([] (auto& options) { options.scale = -1.0; });
  refused ([] (auto& options) { options.mean[1] = std::numeric_limits<double>::quiet_NaN (); });
  refused ([] (auto& options) { options.threads = 0; });
  refused ([] (auto& options) { options.detection.score_threshold = 1.5; });
  refused ([] (auto& options) { options.detection.max_instances = 0; });
}
