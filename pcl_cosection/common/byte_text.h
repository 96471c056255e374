// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pcl::cosection {

/** \brief A size of memory in words: whole MiB, or KiB or bytes if it is less than one. */
inline std::string
byteText (std::size_t bytes)
{
  constexpr std::size_t kibibyte = 1024;
  if (bytes < kibibyte)
    return std::to_string (bytes) + " bytes";
  if (bytes < kibibyte * kibibyte)
    return std::to_string (bytes / kibibyte) + " KiB";
  return std::to_string (bytes / (kibibyte * kibibyte)) + " MiB";
}

} // namespace pcl::cosection
