// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "affine_network.h"

#include "protobuf_message.h"

namespace pcl::cosection::test {
namespace {

using TensorShape = std::vector<std::int64_t>;

// --- ONNX (onnx.proto)
// ---------------------------------------------------------------------------------------------------

constexpr int onnx_float = 1, onnx_int64 = 7;

ProtobufMessage
onnxTensor (const std::string& name, const TensorShape& shape, int type, const std::string& raw)
{
  ProtobufMessage tensor;
  for (const std::int64_t size : shape)
    tensor.number (1, size);
  tensor.number (2, type).text (8, name).text (9, raw);
  return (tensor);
}

ProtobufMessage
onnxNode (const std::string& operation, const std::vector<std::string>& inputs, const std::string& output)
{
  ProtobufMessage node;
  for (const std::string& input : inputs)
    node.text (1, input);
  node.text (2, output).text (3, operation + '_' + output).text (4, operation);
  return (node);
}

ProtobufMessage
onnxValue (const std::string& name, const TensorShape& shape)
{
  ProtobufMessage dimensions;
  for (const std::int64_t size : shape)
    dimensions.message (1, ProtobufMessage ().number (1, size));
  const ProtobufMessage tensor = ProtobufMessage ().number (1, onnx_float).message (2, dimensions);
  return (ProtobufMessage ().text (1, name).message (2, ProtobufMessage ().message (1, tensor)));
}

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
  ProtobufMessage graph;
  graph.message (1, onnxNode ("Reshape", {"image", "row_shape"}, "row")).text (2, "affine");
  graph.message (5, onnxTensor ("row_shape", {2}, onnx_int64, rawBytes (TensorShape{1, -1})));
  graph.message (11, onnxValue ("image", {1, 3, fixed_size ? height : 0, fixed_size ? width : 0}));
  for (const AffineOutput& output : outputs)
  {
    const std::string& name = output.name;
    graph.message (1, onnxNode ("MatMul", {"row", name + "_weights"}, name + "_linear"));
    graph.message (1, onnxNode ("Add", {name + "_linear", name + "_bias"}, name + "_affine"));
    graph.message (1, onnxNode ("Reshape", {name + "_affine", name + "_shape"}, name));
    const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights = output.weights.transpose ();
    graph.message (5,
                   onnxTensor (name + "_weights", {weights.rows (), weights.cols ()}, onnx_float, rawBytes (weights)));
    graph.message (5, onnxTensor (name + "_bias", {1, output.bias.size ()}, onnx_float, rawBytes (output.bias)));
    graph.message (5, onnxTensor (name + "_shape", {static_cast<std::int64_t> (output.shape.size ())}, onnx_int64,
                                  rawBytes (output.shape)));
    graph.message (12, onnxValue (name, output.shape));
  }
  const ProtobufMessage operators = ProtobufMessage ().text (1, "").number (2, 11);
  return (ProtobufMessage ().number (1, 7).message (7, graph).message (8, operators).bytes ());
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
