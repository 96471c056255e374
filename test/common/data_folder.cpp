// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "data_folder.h"

#include <cstdlib>

namespace pcl::cosection::test {

std::filesystem::path
dataFolder (const std::string& name)
{
  const char* const given = std::getenv ("PCL_COSECTION_DATA");
  const std::filesystem::path shared = given != nullptr
                                           ? std::filesystem::path (given)
                                           : std::filesystem::path (PCL_COSECTION_SOURCE_DIR) / "../shared/data";
  return std::filesystem::absolute (shared / name).lexically_normal ();
}

} // namespace pcl::cosection::test
