// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace pcl::cosection {

inline std::string
lowerCase (std::string_view text)
{
  std::string lower (text);
  std::transform (lower.begin (), lower.end (), lower.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::tolower (c)); });
  return lower;
}

inline std::string
lowerCaseExtension (const std::string& path)
{
  return lowerCase (std::filesystem::path (path).extension ().string ());
}

} // namespace pcl::cosection
