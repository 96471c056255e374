// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "affine_network.h"

#include "onnx_messages.h"

namespace pcl::cosection::test {
namespace {

// --- TensorFlow (graph.proto)
// --------------------------------------------------------------------------------------------

constexpr int tensorflow_float = 1, tensorflow_int32 = 3;

ProtobufMessage
tensorflowNode (const std::string& name, const std::string& operation, const std::vector<std::string>& inputs)
{
  ProtobufMessage node;
  node.text (1, name).text (2, operation);
  for (const std::string& input : inputs)
    node.text (3, input);
  return (node);
}

/** \brief An entry of a node's map of attributes. */
ProtobufMessage
attribute (const std::string& key, const ProtobufMessage& value)
{
  return (ProtobufMessage ().text (1, key).message (2, value));
}

ProtobufMessage
tensorflowConstant (const std::string& name, const TensorShape& shape, int type, const std::string& raw)
{
  ProtobufMessage dimensions;
  for (const std::int64_t size : shape)
    dimensions.message (2, ProtobufMessage ().number (1, size));
  const ProtobufMessage tensor = ProtobufMessage ().number (1, type).message (2, dimensions).text (4, raw);
  return (tensorflowNode (name, "Const", {})
              .message (5, attribute ("dtype", ProtobufMessage ().number (6, type)))
              .message (5, attribute ("value", ProtobufMessage ().message (8, tensor))));
}

} // namespace

std::string
affineOnnx (int width, int height, const std::vector<AffineOutput>& outputs, bool fixed_size)
{
  OnnxGraph graph;
  graph.node ("Reshape", {"image", "row_shape"}, {"row"});
  graph.integers ("row_shape", {1, -1});
  graph.input ("image", {1, 3, fixed_size ? height : 0, fixed_size ? width : 0});
  for (const AffineOutput& output : outputs)
  {
    const std::string& name = output.name;
    graph.node ("MatMul", {"row", name + "_weights"}, {name + "_linear"});
    graph.node ("Add", {name + "_linear", name + "_bias"}, {name + "_affine"});
    graph.node ("Reshape", {name + "_affine", name + "_shape"}, {name});
    const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights = output.weights.transpose ();
    graph.tensor (name + "_weights", {weights.rows (), weights.cols ()}, onnx_float, rawBytes (weights));
    graph.tensor (name + "_bias", {1, output.bias.size ()}, onnx_float, rawBytes (output.bias));
    graph.integers (name + "_shape", output.shape);
    graph.output (name, output.shape);
  }
  return (graph.bytes ());
}

std::string
affineTensorflow (int width, int height, const std::vector<AffineOutput>& outputs)
{
  const ProtobufMessage is_float = ProtobufMessage ().number (6, tensorflow_float);
  ProtobufMessage graph;
  graph.message (1, tensorflowNode ("image", "Placeholder", {}).message (5, attribute ("dtype", is_float)));
  for (const AffineOutput& output : outputs)
  {
    const std::string& name = output.name;
    // The kernel of a convolution that is as large as the image: height x width x 3 x values.
    const Eigen::Index values = output.bias.size (), pixels = static_cast<Eigen::Index> (width) * height;
    std::vector<float> kernel;
    for (Eigen::Index pixel = 0; pixel < pixels; ++pixel)
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        for (Eigen::Index value = 0; value < values; ++value)
          kernel.push_back (output.weights (value, channel * pixels + pixel));
    const std::vector<std::int32_t> shape (output.shape.begin (), output.shape.end ());
    graph.message (
        1, tensorflowConstant (name + "_weights", {height, width, 3, values}, tensorflow_float, rawBytes (kernel)));
    graph.message (1, tensorflowConstant (name + "_bias", {values}, tensorflow_float, rawBytes (output.bias)));
    graph.message (1, tensorflowConstant (name + "_shape", {static_cast<std::int64_t> (shape.size ())},
                                          tensorflow_int32, rawBytes (shape)));
    ProtobufMessage strides;
    for (int n = 0; n < 4; ++n)
      strides.number (3, 1);
    graph.message (1, tensorflowNode (name + "_linear", "Conv2D", {"image", name + "_weights"})
                          .message (5, attribute ("T", is_float))
                          .message (5, attribute ("strides", ProtobufMessage ().message (1, strides)))
                          .message (5, attribute ("padding", ProtobufMessage ().text (2, "VALID"))));
    graph.message (1, tensorflowNode (name + "_affine", "BiasAdd", {name + "_linear", name + "_bias"}));
    graph.message (1, tensorflowNode (name, "Reshape", {name + "_affine", name + "_shape"}));
  }
  return (graph.bytes ());
}

} // namespace pcl::cosection::test
