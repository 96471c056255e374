// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace pcl
{
namespace cosection
{
namespace test
{

/** \brief A folder of the shared data, which need not be there: of $PCL_COSECTION_DATA, else of ../shared/data beside the checkout. */
inline std::filesystem::path
dataFolder (const std::string& name)
{
  const char* const given = std::getenv ("PCL_COSECTION_DATA");
  const std::filesystem::path shared =
      given != nullptr ? std::filesystem::path (given) : std::filesystem::path (PCL_COSECTION_SOURCE_DIR) / "../shared/data";
  return std::filesystem::absolute (shared / name).lexically_normal ();
}

} // namespace test
} // namespace cosection
} // namespace pcl
