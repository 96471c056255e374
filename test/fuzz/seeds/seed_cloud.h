// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fuzz {

constexpr int digits = 10; ///< of text; 5405590 m with three more

struct Field
{
  std::string name;
  int size;
  char type;
  int count;
};

/** \brief What a file holds: the value of each element of each field of each point. */
struct Cloud
{
  int width, height;
  std::vector<Field> fields;
  std::vector<std::vector<double>> rows;
  std::string viewpoint;
};

template <typename T>
void
appendAs (std::string& bytes, double value)
{
  const T typed = static_cast<T> (value);
  bytes.append (reinterpret_cast<const char*> (&typed), sizeof (T));
}

inline void
append (std::string& bytes, const Field& field, double value)
{
  if (field.type == 'F')
    return (field.size == 4 ? appendAs<float> (bytes, value) : appendAs<double> (bytes, value));
  switch (field.size) // two's complement: the sign does not matter
  {
  case 1:
    return (appendAs<std::uint8_t> (bytes, value));
  case 2:
    return (appendAs<std::uint16_t> (bytes, value));
  case 4:
    return (appendAs<std::uint32_t> (bytes, value));
  default:
    return (appendAs<std::uint64_t> (bytes, value));
  }
}

} // namespace fuzz
