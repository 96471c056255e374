// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "protobuf_message.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test {

using TensorShape = std::vector<std::int64_t>;

constexpr int onnx_float = 1, onnx_int64 = 7;

/** \brief An ONNX file, part by part (onnx.proto). */
class OnnxGraph
{
public:
  /** \brief A tensor that is in the file. \param[in] raw its values as they stand in memory */
  OnnxGraph& tensor (const std::string& name, const TensorShape& shape, int type, const std::string& raw)
  {
    graph_.message (5, tensorMessage (name, shape, type, raw));
    return (*this);
  }

  /** \brief Numbers from 0.1 on. */
  OnnxGraph& weights (const std::string& name, const TensorShape& shape)
  {
    std::vector<float> values;
    std::int64_t count = 1;
    for (const std::int64_t size : shape)
      count *= size;
    for (std::int64_t n = 0; n < count; ++n)
      values.push_back (0.1f * static_cast<float> (n % 7 + 1));
    return (tensor (name, shape, onnx_float, rawBytes (values)));
  }

  OnnxGraph& integers (const std::string& name, const TensorShape& values)
  {
    return (tensor (name, {static_cast<std::int64_t> (values.size ())}, onnx_int64, rawBytes (values)));
  }

  /** \brief A tensor or another part of the file's graph, as it is. */
  OnnxGraph& part (int field, const ProtobufMessage& message)
  {
    graph_.message (field, message);
    return (*this);
  }

  OnnxGraph& input (const std::string& name, const TensorShape& shape) { return (part (11, value (name, shape))); }
  OnnxGraph& output (const std::string& name, const TensorShape& shape) { return (part (12, value (name, shape))); }

  OnnxGraph& node (const std::string& operation, const std::vector<std::string>& inputs,
                   const std::vector<std::string>& outputs, const std::vector<ProtobufMessage>& attributes = {})
  {
    ProtobufMessage node;
    for (const std::string& input : inputs)
      node.text (1, input);
    for (const std::string& output : outputs)
      node.text (2, output);
    node.text (3, operation + '_' + (outputs.empty () ? "" : outputs.front ())).text (4, operation);
    for (const ProtobufMessage& attribute : attributes)
      node.message (5, attribute);
    return (part (1, node));
  }

  std::string bytes (int operators = 11) const
  {
    const ProtobufMessage version = ProtobufMessage ().text (1, "").number (2, operators);
    return (ProtobufMessage ().number (1, 7).message (7, graph_).message (8, version).bytes ());
  }

  static ProtobufMessage tensorMessage (const std::string& name, const TensorShape& shape, int type,
                                        const std::string& raw)
  {
    ProtobufMessage tensor;
    for (const std::int64_t size : shape)
      tensor.number (1, size);
    tensor.number (2, type).text (8, name).text (9, raw);
    return (tensor);
  }

  static ProtobufMessage attribute (const std::string& name, std::int64_t value)
  {
    return (ProtobufMessage ().text (1, name).number (3, value).number (20, 2));
  }

  static ProtobufMessage attribute (const std::string& name, const TensorShape& values)
  {
    ProtobufMessage message;
    message.text (1, name);
    for (const std::int64_t value : values)
      message.number (8, value);
    return (message.number (20, 7));
  }

  static ProtobufMessage attribute (const std::string& name, const ProtobufMessage& tensor)
  {
    return (ProtobufMessage ().text (1, name).message (5, tensor).number (20, 4));
  }

private:
  static ProtobufMessage value (const std::string& name, const TensorShape& shape)
  {
    ProtobufMessage dimensions;
    for (const std::int64_t size : shape)
      dimensions.message (1, ProtobufMessage ().number (1, size));
    const ProtobufMessage tensor = ProtobufMessage ().number (1, onnx_float).message (2, dimensions);
    return (ProtobufMessage ().text (1, name).message (2, ProtobufMessage ().message (1, tensor)));
  }

  ProtobufMessage graph_;
};

} // namespace pcl::cosection::test
