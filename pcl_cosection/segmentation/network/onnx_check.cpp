// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "onnx_check.h"

#include <pcl/cosection/common/error.h>

#include <onnx/onnx_pb.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <sstream>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr std::uint64_t largest_size = std::numeric_limits<int>::max (); ///< OpenCV's sizes are of this type
constexpr std::size_t longest_name = 60;

/** \brief A name as it is in the file, in quotes and one line. */
std::string
quoted (const std::string& name)
{
  std::string text = name.size () > longest_name ? name.substr (0, longest_name) + "..." : name;
  std::replace_if (
      text.begin (), text.end (), [] (unsigned char c) { return (c < ' '); }, ' ');
  return ('"' + text + '"');
}

// --- Tensors
// ---------------------------------------------------------------------------------------------------------------

/** \brief How the values of a type are stored. */
struct Storage
{
  std::uint64_t value_size; ///< bytes in the raw data; 0: there is no such type
  int values;               ///< in the field for this type
};

Storage
storageOf (const onnx::TensorProto& tensor)
{
  switch (tensor.data_type ())
  {
  case onnx::TensorProto::FLOAT:
    return {4, tensor.float_data_size ()};
  case onnx::TensorProto::DOUBLE:
    return {8, tensor.double_data_size ()};
  case onnx::TensorProto::INT64:
    return {8, tensor.int64_data_size ()};
  case onnx::TensorProto::INT32:
    return {4, tensor.int32_data_size ()};
  case onnx::TensorProto::FLOAT16:
  case onnx::TensorProto::BFLOAT16:
  case onnx::TensorProto::INT16:
  case onnx::TensorProto::UINT16:
    return {2, tensor.int32_data_size ()};
  case onnx::TensorProto::BOOL:
  case onnx::TensorProto::INT8:
  case onnx::TensorProto::UINT8:
    return {1, tensor.int32_data_size ()};
  case onnx::TensorProto::UINT32:
    return {4, tensor.uint64_data_size ()};
  case onnx::TensorProto::UINT64:
    return {8, tensor.uint64_data_size ()};
  default: // also those of texts and complex numbers, which OpenCV does not read
    return {0, 0};
  }
}

/** \brief "1 x 3 x 2". */
std::string
dimensionsText (const onnx::TensorProto& tensor)
{
  if (tensor.dims_size () == 0)
    return ("1");
  std::ostringstream text;
  for (int n = 0; n < tensor.dims_size (); ++n)
    text << (n > 0 ? " x " : "") << tensor.dims (n);
  return (text.str ());
}

/** \brief Number of values of a tensor. \throws IoError if it is too large for OpenCV, or negative */
std::uint64_t
valuesOf (const onnx::TensorProto& tensor, const std::string& name)
{
  std::uint64_t values = 1;
  for (const std::int64_t size : tensor.dims ())
  {
    // Sizes of 0 count as 1 here, as others must be small beside them too.
    if (size < 0 || static_cast<std::uint64_t> (size) > largest_size ||
        values > largest_size / std::max<std::uint64_t> (1, static_cast<std::uint64_t> (size)))
      throw IoError (name + " cannot have " + dimensionsText (tensor) + " values");
    values *= std::max<std::uint64_t> (1, static_cast<std::uint64_t> (size));
  }
  return (std::count (tensor.dims ().begin (), tensor.dims ().end (), 0) > 0 ? 0 : values);
}

void
checkTensor (const onnx::TensorProto& tensor, const std::string& owner)
{
  constexpr int most_dimensions = 32;
  const std::string name = "tensor " + quoted (tensor.name ().empty () ? owner : tensor.name ());
  if (tensor.data_location () == onnx::TensorProto::EXTERNAL || tensor.external_data_size () > 0)
    throw IoError (name + " is in another file, which OpenCV does not read");
  const Storage storage = storageOf (tensor);
  if (storage.value_size == 0)
    throw IoError (name + " is of a type that OpenCV does not have: " + std::to_string (tensor.data_type ()));
  if (tensor.dims_size () > most_dimensions)
    throw IoError (name + " has " + std::to_string (tensor.dims_size ()) + " dimensions");
  const std::uint64_t values = valuesOf (tensor, name);
  if (storage.values > 0)
  {
    if (static_cast<std::uint64_t> (storage.values) != values)
      throw IoError (name + " has " + std::to_string (storage.values) + " values, but its dimensions are " +
                     dimensionsText (tensor));
  }
  else if (tensor.raw_data ().size () != values * storage.value_size)
    throw IoError (name + " has " + std::to_string (tensor.raw_data ().size ()) + " bytes of data, but its " +
                   dimensionsText (tensor) + " values need " + std::to_string (values * storage.value_size));
}

void
checkSparseTensor (const onnx::SparseTensorProto& tensor, const std::string& owner)
{
  checkTensor (tensor.values (), owner);
  checkTensor (tensor.indices (), owner);
}

// --- Nodes
// ---------------------------------------------------------------------------------------------------------------

void checkGraph (const onnx::GraphProto& graph);

/** \brief Sizes by which OpenCV divides, or which it multiplies, must be positive. */
void
checkSizes (const onnx::AttributeProto& attribute, const std::string& node)
{
  static const std::array<const char*, 4> positive = {"group", "kernel_shape", "strides", "dilations"};
  if (std::find (positive.begin (), positive.end (), attribute.name ()) == positive.end ())
    return;
  std::vector<std::int64_t> sizes (attribute.ints ().begin (), attribute.ints ().end ());
  if (attribute.has_i () || sizes.empty ())
    sizes.push_back (attribute.i ());
  for (const std::int64_t size : sizes)
    if (size < 1 || static_cast<std::uint64_t> (size) > largest_size)
      throw IoError (node + " has a " + attribute.name () + " of " + std::to_string (size));
}

void
checkNode (const onnx::NodeProto& node)
{
  const std::string label = quoted (!node.name ().empty () || node.output_size () == 0 ? node.name ()
                                                                                       : node.output (0));
  const std::string name = "node " + label + " (" + quoted (node.op_type ()) + ")";
  for (const onnx::AttributeProto& attribute : node.attribute ())
  {
    checkSizes (attribute, name);
    if (attribute.has_t ())
      checkTensor (attribute.t (), attribute.name ());
    if (attribute.has_sparse_tensor ())
      checkSparseTensor (attribute.sparse_tensor (), attribute.name ());
    if (attribute.has_g ())
      checkGraph (attribute.g ());
    for (const onnx::TensorProto& tensor : attribute.tensors ())
      checkTensor (tensor, attribute.name ());
    for (const onnx::SparseTensorProto& tensor : attribute.sparse_tensors ())
      checkSparseTensor (tensor, attribute.name ());
    for (const onnx::GraphProto& graph : attribute.graphs ())
      checkGraph (graph);
  }
}

/** \brief What nodes use must have been made before; OpenCV would leave it out. */
void
checkOrder (const onnx::GraphProto& graph)
{
  std::set<std::string> known = {""}; // an optional input that is left out
  for (const onnx::ValueInfoProto& input : graph.input ())
    known.insert (input.name ());
  for (const onnx::TensorProto& tensor : graph.initializer ())
    known.insert (tensor.name ());
  for (const onnx::SparseTensorProto& tensor : graph.sparse_initializer ())
    known.insert (tensor.values ().name ());
  for (const onnx::NodeProto& node : graph.node ())
  {
    for (const std::string& input : node.input ())
      if (known.count (input) == 0)
        throw IoError ("node " + quoted (node.name ()) + " (" + quoted (node.op_type ()) + ") uses " + quoted (input) +
                       ", which is not there before it");
    known.insert (node.output ().begin (), node.output ().end ());
  }
}

void
checkGraph (const onnx::GraphProto& graph)
{
  for (const onnx::TensorProto& tensor : graph.initializer ())
    checkTensor (tensor, "");
  for (const onnx::SparseTensorProto& tensor : graph.sparse_initializer ())
    checkSparseTensor (tensor, "");
  for (const onnx::NodeProto& node : graph.node ())
    checkNode (node);
}

} // namespace

void
checkOnnx (const std::string& bytes)
{
  onnx::ModelProto model;
  if (bytes.size () > largest_size || !model.ParseFromArray (bytes.data (), static_cast<int> (bytes.size ())))
    throw IoError ("it is not an ONNX file, or damaged");
  if (model.graph ().node_size () == 0)
    throw IoError ("it holds no network");
  checkGraph (model.graph ());
  checkOrder (model.graph ());
}

} // namespace pcl::cosection
