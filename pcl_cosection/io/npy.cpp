// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "npy.h"

#include <pcl/cosection/common/error.h>

#include <functional>
#include <numeric>

namespace pcl::cosection {

std::string
encodeNpy (const std::vector<float>& values, const std::vector<std::size_t>& shape)
{
  if (std::accumulate (shape.begin (), shape.end (), std::size_t{1}, std::multiplies<> ()) != values.size ())
    throw InvalidArgument ("encodeNpy: " + std::to_string (values.size ()) + " values do not fill the shape");
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (const std::size_t size : shape)
    header += std::to_string (size) + ", "; // Python allows the last comma, and needs it for a single size
  header += "), }";
  std::string bytes ("\x93NUMPY\x01\x00", 8);
  constexpr std::size_t alignment = 64, length_bytes = 2;
  const std::size_t unpadded = bytes.size () + length_bytes + header.size () + 1;
  header.append ((alignment - unpadded % alignment) % alignment, ' ');
  header += '\n';
  bytes += static_cast<char> (header.size () & 0xff);
  bytes += static_cast<char> (header.size () >> 8);
  bytes += header;
  return bytes.append (reinterpret_cast<const char*> (values.data ()), values.size () * sizeof (float));
}

} // namespace pcl::cosection
