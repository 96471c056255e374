// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "network_text.h"

#include "segmentation/onnx_messages.h"

#include <sstream>
#include <vector>

using pcl::cosection::test::onnx_int64;
using pcl::cosection::test::OnnxGraph;
using pcl::cosection::test::ProtobufMessage;
using pcl::cosection::test::rawBytes;
using pcl::cosection::test::TensorShape;

namespace fuzz {
namespace {

TensorShape
numbers (std::istream& in, char between = ' ')
{
  TensorShape values;
  for (std::string word; std::getline (in, word, between);)
    if (std::int64_t value = 0; std::istringstream (word) >> value)
      values.push_back (value);
  return (values);
}

void
addTensor (OnnxGraph& graph, const std::string& name, const TensorShape& shape)
{
  constexpr double most_values = 1 << 16;
  double values = 1.0;
  for (const std::int64_t size : shape)
    values *= static_cast<double> (size);
  if (values >= 0.0 && values <= most_values)
    graph.weights (name, shape);
}

void
addNode (OnnxGraph& graph, const std::string& operation, std::istream& in)
{
  std::vector<std::string> inputs, outputs;
  std::vector<ProtobufMessage> attributes;
  bool is_output = false;
  for (std::string word; in >> word;)
  {
    const std::size_t equals = word.find ('=');
    if (word == ">")
      is_output = true;
    else if (equals == word.npos)
      (is_output ? outputs : inputs).push_back (word == "-" ? "" : word);
    else
    {
      std::istringstream values (word.substr (equals + 1));
      const std::string name = word.substr (0, equals);
      const TensorShape sizes = numbers (values, ',');
      attributes.push_back (sizes.size () == 1 ? OnnxGraph::attribute (name, sizes[0])
                                               : OnnxGraph::attribute (name, sizes));
    }
  }
  graph.node (operation, inputs, outputs, attributes);
}

} // namespace

std::string
networkText ()
{
  return ("input image 1 3 16 24\n"
          "tensor kernel 4 3 3 3\n"
          "tensor bias 4\n"
          "tensor slope 4 1 1\n"
          "integers zero 0\n"
          "integers four 4\n"
          "integers one 1\n"
          "integers shape 1 6 -1\n"
          "scalar second 1\n"
          "Conv image kernel bias > conv strides=1,1 dilations=1,1 kernel_shape=3,3 pads=1,1,1,1 group=1\n"
          "BatchNormalization conv bias bias bias bias > normal\n"
          "PRelu normal slope > relu\n"
          "MaxPool relu > pool kernel_shape=2,2 strides=2,2\n"
          "Slice pool zero four one one > slice\n"
          "Gather slice second > gather axis=1\n"
          "Unsqueeze gather > channel axes=1,\n"
          "Split slice > left right mask axis=1 split=2,1,1\n"
          "Sigmoid mask > output1\n"
          "Sigmoid left > sigmoid\n"
          "Concat sigmoid right channel > both axis=1\n"
          "Transpose both > transposed perm=0,2,3,1\n"
          "Softmax transposed > shares axis=3\n"
          "Reshape shares shape > output0\n"
          "output output0 1 6 64\n"
          "output output1 1 1 8 12\n");
}

std::string
onnxFromText (const std::string& text)
{
  OnnxGraph graph;
  std::istringstream lines (text);
  for (std::string line; std::getline (lines, line);)
  {
    std::istringstream words (line);
    std::string kind, name;
    words >> kind;
    if (kind != "input" && kind != "output" && kind != "tensor" && kind != "integers" && kind != "scalar")
    {
      addNode (graph, kind, words);
      continue;
    }
    words >> name;
    TensorShape values = numbers (words);
    if (kind == "input")
      graph.input (name, values);
    else if (kind == "output")
      graph.output (name, values);
    else if (kind == "integers")
      graph.integers (name, values);
    else if (kind == "scalar")
    {
      values.resize (1);
      graph.tensor (name, {}, onnx_int64, rawBytes (values));
    }
    else
      addTensor (graph, name, values);
  }
  return (graph.bytes ());
}

} // namespace fuzz
