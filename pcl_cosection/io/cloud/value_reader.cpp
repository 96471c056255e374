// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "value_reader.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace pcl::cosection {
namespace {

template <typename T>
double
load (const char* data)
{
  T value;
  std::memcpy (&value, data, sizeof (T));
  return static_cast<double> (value);
}

double
load (ScalarType type, const char* data)
{
  switch (type)
  {
  case ScalarType::Int8:
    return load<std::int8_t> (data);
  case ScalarType::UInt8:
    return load<std::uint8_t> (data);
  case ScalarType::Int16:
    return load<std::int16_t> (data);
  case ScalarType::UInt16:
    return load<std::uint16_t> (data);
  case ScalarType::Int32:
    return load<std::int32_t> (data);
  case ScalarType::UInt32:
    return load<std::uint32_t> (data);
  case ScalarType::Int64:
    return load<std::int64_t> (data);
  case ScalarType::UInt64:
    return load<std::uint64_t> (data);
  case ScalarType::Float32:
    return load<float> (data);
  case ScalarType::Float64:
    break;
  }
  return load<double> (data);
}

} // namespace

std::size_t
sizeOf (ScalarType type)
{
  switch (type)
  {
  case ScalarType::Int8:
  case ScalarType::UInt8:
    return 1;
  case ScalarType::Int16:
  case ScalarType::UInt16:
    return 2;
  case ScalarType::Int32:
  case ScalarType::UInt32:
  case ScalarType::Float32:
    return 4;
  case ScalarType::Int64:
  case ScalarType::UInt64:
  case ScalarType::Float64:
    break;
  }
  return 8;
}

void
ValueReader::failShort () const
{
  throw IoError ("the " + what_ + " file is shorter than its header says");
}

void
ValueReader::require (std::uint64_t count, std::size_t bytes, std::size_t values) const
{
  // A value of text takes a character and one between it and the next.
  const std::size_t each = (encoding_ == Encoding::Ascii ? 2 * values : bytes);
  const std::size_t left = scanner_.left ().size () + (encoding_ == Encoding::Ascii ? 1 : 0);
  if (each != 0 && count > left / each)
    failShort ();
}

double
ValueReader::next (ScalarType type)
{
  if (encoding_ == Encoding::Ascii)
  {
    const std::string_view word = scanner_.word ();
    if (word.empty ())
      failShort ();
    return toReal (word);
  }
  const std::string_view bytes = scanner_.bytes (sizeOf (type));
  if (bytes.size () != sizeOf (type))
    failShort ();
  if (encoding_ == Encoding::LittleEndian)
    return load (type, bytes.data ());
  std::array<char, 8> swapped;
  std::reverse_copy (bytes.begin (), bytes.end (), swapped.begin ());
  return load (type, swapped.data ());
}

std::int64_t
ValueReader::nextIndex (ScalarType type)
{
  constexpr double most = 1e15; // far more than there can be, and exact
  const double value = next (type);
  return value >= 0.0 && value <= most ? static_cast<std::int64_t> (value) : -1;
}

} // namespace pcl::cosection
