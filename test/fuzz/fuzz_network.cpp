// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a network: the first line is the extension of its file, the file follows; for TensorFlow, after a line "%%"
// the text graph. After ".text", a text that is made an ONNX file.

#include "fuzz_target.h"
#include "memory_file.h"
#include "network_text.h"
#include "segmentation/affine_network.h"
#include "segmentation/spot_network.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/instance_detector.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

constexpr int width = test::SpotNetwork::width, height = test::SpotNetwork::height;
const std::string between = "\n%%\n";

/** \brief The text graph of a network of TensorFlow, whose weights are in the binary one. */
std::string
textGraph (const std::vector<test::AffineOutput>& outputs)
{
  const auto node = [] (const std::string& name, const std::string& operation, const std::string& inputs,
                        const std::string& more) {
    return ("node {\n name: \"" + name + "\"\n op: \"" + operation + "\"\n" + inputs + more + "}\n");
  };
  const auto input = [] (const std::string& name) { return (" input: \"" + name + "\"\n"); };
  std::string text = node ("image", "Placeholder", "", "");
  for (const auto& [name, shape, weights, bias] : outputs)
  {
    text += node (name + "_linear", "Conv2D", input ("image") + input (name + "_weights"),
                  " attr { key: \"strides\" value { list { i: 1 i: 1 i: 1 i: 1 } } }\n"
                  " attr { key: \"padding\" value { s: \"VALID\" } }\n");
    text += node (name + "_affine", "BiasAdd", input (name + "_linear") + input (name + "_bias"), "");
    text += node (name, "Reshape", input (name + "_affine") + input (name + "_shape"), "");
  }
  return (text);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  std::vector<std::string> result = {".text\n" + networkText (), ".onnx\n" + onnxFromText (networkText ())};
  for (const NetworkOutputForm form :
       {NetworkOutputForm::DetectionOut, NetworkOutputForm::BoxList, NetworkOutputForm::Prototypes})
    result.push_back (".onnx\n" + test::affineOnnx (width, height, test::SpotNetwork{form}.outputs ()));
  std::vector<test::AffineOutput> boxes = test::SpotNetwork{NetworkOutputForm::BoxList}.outputs ();
  boxes[3].shape.erase (boxes[3].shape.begin ());
  result.push_back (".pb\n" + test::affineTensorflow (width, height, boxes));
  result.push_back (result.back () + between + textGraph (boxes));
  return (result);
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {".onnx\n",
          ".pb\n",
          "Conv",
          "ConvTranspose",
          "MaxPool",
          "AveragePool",
          "Reshape",
          "Gather",
          "Split",
          "Slice",
          "Concat",
          "Transpose",
          "MatMul",
          "Gemm",
          "Add",
          "Resize",
          "Unsqueeze",
          "Squeeze",
          "Expand",
          "Constant",
          "Cast",
          "Pad",
          "LSTM",
          "Shape",
          "Flatten",
          "ReduceMean",
          "Softmax",
          "PRelu",
          "image",
          "BatchNormalization",
          "ConstantOfShape",
          "Identity",
          "Upsample",
          "DepthToSpace",
          "group",
          "strides",
          "kernel_shape",
          "axis",
          "perm",
          "pads",
          "Conv2D",
          "Const",
          "Placeholder",
          "BiasAdd",
          "ResizeBilinear",
          "CropAndResize",
          "Sum",
          "FusedBatchNorm",
          std::string (1, '\0'),
          std::string ("\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01")};
}

bool
fuzz::accepts (const std::string& input)
{
  static NamedMemoryFile file, config;
  const std::size_t end = std::min (input.find ('\n'), input.size ());
  const std::string rest = input.substr (std::min (end + 1, input.size ()));
  const std::size_t model_end = std::min (rest.rfind (between), rest.size ());
  InstanceDetectorOptions options;
  const std::string extension = input.substr (0, end);
  options.model = file.path (extension == ".pb" ? ".pb" : ".onnx");
  file.set (extension == ".text" ? onnxFromText (rest) : rest.substr (0, model_end));
  if (model_end < rest.size () && options.model.back () == 'b')
  {
    options.config = config.path (".pbtxt");
    config.set (rest.substr (model_end + between.size ()));
  }
  options.input_width = width;
  options.input_height = height;
  try
  {
    InstanceDetector detector (options);
    detector.detect (Picture (width, height, {200, 10, 0}));
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  return (true);
}
