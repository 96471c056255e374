// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace pcl::cosection {

inline std::string
lowerCaseExtension (const std::string& path)
{
  std::string extension = std::filesystem::path (path).extension ().string ();
  std::transform (extension.begin (), extension.end (), extension.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::tolower (c)); });
  return extension;
}

} // namespace pcl::cosection
