// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "onnx_input.h"

#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

namespace pcl::cosection
{

namespace
{

// Numbers of fields in onnx.proto.
constexpr std::uint64_t model_graph = 7;
constexpr std::uint64_t graph_initializer = 5, graph_input = 11;
constexpr std::uint64_t tensor_name = 8;
constexpr std::uint64_t value_name = 1, value_type = 2;
constexpr std::uint64_t type_tensor = 1, tensor_shape = 2, shape_dim = 1, dim_value = 1;

constexpr std::uint64_t largest_size = 8192; // pixels

/** \brief A field of a message in the encoding of Protocol Buffers. */
struct Field
{
  std::uint64_t number = 0;
  std::uint64_t value = 0; // of a varint
  std::string_view bytes;  // of what has a length
};

/** \brief Reads a message field by field. */
class Message
{
public:
  explicit Message (std::string_view bytes) : rest_ (bytes) {}

  /** \return nothing at the end, and where the bytes are no message */
  std::optional<Field> next ()
  {
    const auto key = varint ();
    if (!key)
      return std::nullopt;
    Field field;
    field.number = *key >> 3;
    switch (*key & 7)
    {
    case 0:
      if (const auto value = varint ())
      {
        field.value = *value;
        return field;
      }
      return std::nullopt;
    case 1:
      return take (8, field);
    case 2:
      if (const auto length = varint ())
        return take (*length, field);
      return std::nullopt;
    case 5:
      return take (4, field);
    default:
      return std::nullopt;
    }
  }

private:
  std::optional<std::uint64_t> varint ()
  {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty (); shift += 7)
    {
      const auto byte = static_cast<std::uint8_t> (rest_.front ());
      rest_.remove_prefix (1);
      value |= static_cast<std::uint64_t> (byte & 0x7F) << shift;
      if (byte < 0x80)
        return value;
    }
    return std::nullopt;
  }

  std::optional<Field> take (std::uint64_t length, Field field)
  {
    if (length > rest_.size ())
      return std::nullopt;
    field.bytes = rest_.substr (0, length);
    rest_.remove_prefix (length);
    return field;
  }

  std::string_view rest_;
};

/** \brief The last field of a number, as a message's value is where it is given twice; empty: none. */
std::string_view
fieldOf (std::string_view message, std::uint64_t number)
{
  std::string_view found;
  Message reader (message);
  while (const auto field = reader.next ())
    if (field->number == number)
      found = field->bytes;
  return found;
}

/** \brief 0: one that is not fixed. */
std::vector<std::uint64_t>
dimensions (std::string_view value_info)
{
  std::vector<std::uint64_t> result;
  Message shape (fieldOf (fieldOf (fieldOf (value_info, value_type), type_tensor), tensor_shape));
  while (const auto dim = shape.next ())
    if (dim->number == shape_dim)
    {
      result.push_back (0);
      Message reader (dim->bytes);
      while (const auto field = reader.next ())
        if (field->number == dim_value)
          result.back () = field->value;
    }
  return result;
}

} // namespace

std::optional<InputSize>
onnxInputSize (const std::string& model)
{
  std::set<std::string_view> weights; // old files list them among the inputs
  std::vector<std::string_view> inputs;
  Message graph (fieldOf (model, model_graph));
  while (const auto field = graph.next ())
    if (field->number == graph_initializer)
      weights.insert (fieldOf (field->bytes, tensor_name));
    else if (field->number == graph_input)
      inputs.push_back (field->bytes);
  for (const std::string_view input : inputs)
  {
    if (weights.count (fieldOf (input, value_name)) > 0)
      continue;
    const std::vector<std::uint64_t> shape = dimensions (input);
    if (shape.size () != 4 || shape[2] == 0 || shape[3] == 0 || shape[2] > largest_size || shape[3] > largest_size)
      return std::nullopt;
    return InputSize{static_cast<int> (shape[3]), static_cast<int> (shape[2])};
  }
  return std::nullopt;
}

} // namespace pcl::cosection
