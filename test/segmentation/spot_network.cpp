// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "spot_network.h"

namespace pcl::cosection::test {
namespace {

AffineOutput
constantOutput (const std::string& name, const std::vector<std::int64_t>& shape,
                int inputs = 3 * SpotNetwork::width * SpotNetwork::height)
{
  std::int64_t values = 1;
  for (const std::int64_t size : shape)
    values *= size;
  return {name, shape, Eigen::MatrixXf::Zero (values, inputs), Eigen::VectorXf::Zero (values)};
}

/** \brief Make a value an edge of the spot's box: the centroid of its colour plus an offset. */
void
setEdge (AffineOutput& output, Eigen::Index value, bool horizontal, float beside, float unit, float brightest)
{
  const float pixels = SpotNetwork::spot_width * SpotNetwork::spot_height;
  for (int v = 0; v < SpotNetwork::height; ++v)
    for (int u = 0; u < SpotNetwork::width; ++u)
      output.weights (value, v * SpotNetwork::width + u) = ((horizontal ? u : v) + 0.5f) / (pixels * brightest * unit);
  output.bias[value] = beside / unit;
}

/** \brief Make four values the box's left, top, right and bottom, in units of some pixels. */
void
setCorners (AffineOutput& output, Eigen::Index value, float unit_x, float unit_y, float brightest)
{
  const float half_width = 0.5f * SpotNetwork::spot_width, half_height = 0.5f * SpotNetwork::spot_height;
  setEdge (output, value, true, -half_width, unit_x, brightest);
  setEdge (output, value + 1, false, -half_height, unit_y, brightest);
  setEdge (output, value + 2, true, half_width, unit_x, brightest);
  setEdge (output, value + 3, false, half_height, unit_y, brightest);
}

std::vector<AffineOutput>
detectionOut (float brightest)
{
  AffineOutput detections = constantOutput ("detection_out_final", {1, 1, 2, 7});
  detections.bias[1] = 2.0f;
  detections.bias[2] = 0.9f;
  setCorners (detections, 3, SpotNetwork::width, SpotNetwork::height, brightest);
  detections.bias[7 + 2] = 0.3f; // a detection with a low score
  detections.bias.segment (7 + 5, 2).setOnes ();
  AffineOutput masks = constantOutput ("detection_masks", {2, 3, 2, 2});
  masks.bias[2 * 4] = masks.bias[2 * 4 + 2] = 1.0f; // left half, in the channel of class 2
  return {detections, masks};
}

std::vector<AffineOutput>
boxList (float brightest)
{
  AffineOutput boxes = constantOutput ("boxes", {1, 4}), labels = constantOutput ("labels", {1}),
               scores = constantOutput ("scores", {1}), masks = constantOutput ("masks", {1, 1, 2, 2});
  setCorners (boxes, 0, 1.0f, 1.0f, brightest);
  labels.bias[0] = 2.0f;
  scores.bias[0] = 0.9f;
  masks.bias[0] = masks.bias[2] = 1.0f;
  return {boxes, labels, scores, masks};
}

std::vector<AffineOutput>
prototypes (float brightest)
{
  constexpr int candidates = 10;
  AffineOutput proposals = constantOutput ("output0", {1, 4 + 3 + 2, candidates}); // box, classes, coefficients
  for (const int candidate : {0, 1})                                               // the second one is a duplicate
  {
    setEdge (proposals, candidate, true, 0.5f * candidate, 1.0f, brightest);
    setEdge (proposals, candidates + candidate, false, 0.0f, 1.0f, brightest);
    proposals.bias[2 * candidates + candidate] = SpotNetwork::spot_width;
    proposals.bias[3 * candidates + candidate] = SpotNetwork::spot_height;
    proposals.bias[6 * candidates + candidate] = 0.9f - 0.1f * candidate;
    proposals.bias[7 * candidates + candidate] = 1.0f;
  }
  constexpr int width = SpotNetwork::width, height = SpotNetwork::height;
  AffineOutput masks = constantOutput ("output1", {1, 2, height / 2, width / 2});
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      masks.weights (v / 2 * (width / 2) + u / 2, v * width + u) = 0.25f * 20.0f / brightest;
  masks.bias.head (height / 2 * (width / 2)).setConstant (-10.0f);
  masks.bias.tail (height / 2 * (width / 2)).setConstant (10.0f); // the other prototype is everything
  return {proposals, masks};
}

} // namespace

std::vector<AffineOutput>
SpotNetwork::outputs () const
{
  return (form == NetworkOutputForm::DetectionOut ? detectionOut (brightest)
          : form == NetworkOutputForm::BoxList    ? boxList (brightest)
                                                  : prototypes (brightest));
}

std::vector<AffineOutput>
colourNetwork (int width, int height, const std::vector<Eigen::Vector3f>& colours, float threshold)
{
  constexpr float steepness = 100.0f;
  const auto classes = static_cast<Eigen::Index> (colours.size ());
  const Eigen::Index pixels = static_cast<Eigen::Index> (width) * height, candidates = 4 + 3 * classes;
  AffineOutput proposals = constantOutput ("output0", {1, 4 + 2 * classes, candidates}, static_cast<int> (3 * pixels));
  AffineOutput masks = constantOutput ("output1", {1, classes, height, width}, static_cast<int> (3 * pixels));
  for (Eigen::Index n = 0; n < classes; ++n)
  {
    const std::vector<float> box = {0.5f * width, 0.5f * height, static_cast<float> (width),
                                    static_cast<float> (height)};
    for (Eigen::Index k = 0; k < 4; ++k)
      proposals.bias[k * candidates + n] = box[static_cast<std::size_t> (k)];
    proposals.bias[(4 + n) * candidates + n] = 0.9f;
    proposals.bias[(4 + classes + n) * candidates + n] = 1.0f;
    for (Eigen::Index pixel = 0; pixel < pixels; ++pixel)
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        masks.weights (n * pixels + pixel, channel * pixels + pixel) = steepness *
                                                                       colours[static_cast<std::size_t> (n)][channel];
    masks.bias.segment (n * pixels, pixels).setConstant (-steepness * threshold);
  }
  return {proposals, masks};
}

Picture
spotPicture (int left, int top, const std::array<std::uint8_t, 3>& colour, int enlarged, int picture_width,
             int picture_height)
{
  Picture picture (enlarged * picture_width, enlarged * picture_height, {0, 0, 0});
  for (int v = enlarged * top; v < enlarged * (top + SpotNetwork::spot_height); ++v)
    for (int u = enlarged * left; u < enlarged * (left + SpotNetwork::spot_width); ++u)
      picture.at (u, v) = colour;
  return (picture);
}

} // namespace pcl::cosection::test
