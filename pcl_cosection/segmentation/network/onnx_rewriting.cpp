// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "onnx_rewriting.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Core>
#include <onnx/onnx_pb.h>

#include <algorithm>
#include <cstring>

namespace pcl::cosection {
namespace {

onnx::ModelProto
parse (const std::string& bytes)
{
  onnx::ModelProto model;
  if (!model.ParseFromArray (bytes.data (), static_cast<int> (bytes.size ())))
    throw IoError ("it is not an ONNX file, or damaged");
  return (model);
}

/** \brief The first input that no weights are given for, or nullptr. Old files list weights too. */
onnx::ValueInfoProto*
inputOf (onnx::GraphProto& graph)
{
  for (onnx::ValueInfoProto& input : *graph.mutable_input ())
    if (std::none_of (graph.initializer ().begin (), graph.initializer ().end (),
                      [&] (const onnx::TensorProto& tensor) { return (tensor.name () == input.name ()); }))
      return (&input);
  return (nullptr);
}

/** \brief Exporters write 0, -1 or a name for a size that is not known. */
bool
isOpen (const onnx::TensorShapeProto::Dimension& dimension)
{
  return (dimension.dim_value () <= 0);
}

} // namespace

std::string
inSinglePrecision (const std::string& bytes)
{
  onnx::ModelProto model = parse (bytes);
  for (onnx::TensorProto& tensor : *model.mutable_graph ()->mutable_initializer ())
  {
    if (tensor.data_type () != onnx::TensorProto::FLOAT16 || tensor.raw_data ().empty ())
      continue;
    const std::string half = tensor.raw_data ();
    std::vector<float> values (half.size () / sizeof (Eigen::half));
    for (std::size_t n = 0; n < values.size (); ++n)
    {
      Eigen::half value;
      std::memcpy (&value, half.data () + n * sizeof (value), sizeof (value));
      values[n] = static_cast<float> (value);
    }
    tensor.set_data_type (onnx::TensorProto::FLOAT);
    tensor.set_raw_data (values.data (), values.size () * sizeof (float));
  }
  return (model.SerializeAsString ());
}

std::optional<std::vector<std::string>>
outputsOfOpenInput (const std::string& bytes, int dimensions)
{
  onnx::ModelProto model = parse (bytes);
  const onnx::ValueInfoProto* const input = inputOf (*model.mutable_graph ());
  if (!input || !input->type ().has_tensor_type ())
    return (std::nullopt);
  const onnx::TensorShapeProto& shape = input->type ().tensor_type ().shape ();
  if (shape.dim_size () != dimensions || std::none_of (shape.dim ().begin (), shape.dim ().end (), isOpen))
    return (std::nullopt);
  std::vector<std::string> names;
  for (const onnx::ValueInfoProto& output : model.graph ().output ())
    names.push_back (output.name ());
  return (names);
}

std::string
withInputShape (const std::string& bytes, const std::vector<int>& shape)
{
  onnx::ModelProto model = parse (bytes);
  if (onnx::ValueInfoProto* const input = inputOf (*model.mutable_graph ()); input && input->type ().has_tensor_type ())
  {
    onnx::TensorShapeProto& given = *input->mutable_type ()->mutable_tensor_type ()->mutable_shape ();
    for (int n = 0; n < given.dim_size () && n < static_cast<int> (shape.size ()); ++n)
      if (isOpen (given.dim (n)))
        given.mutable_dim (n)->set_dim_value (shape[static_cast<std::size_t> (n)]);
  }
  return (model.SerializeAsString ());
}

} // namespace pcl::cosection
