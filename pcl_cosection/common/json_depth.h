// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pcl::cosection {

/** \brief Whether a text has so many brackets within each other that what walks through its JSON by recursion, as
 * nlohmann::json does to copy and to write, could run out of stack. */
inline bool
nestsDeeply (const std::string& json)
{
  constexpr int most = 1000;
  int depth = 0;
  bool quoted = false;
  for (std::size_t n = 0; n < json.size (); ++n)
  {
    const char c = json[n];
    if (quoted)
    {
      n += c == '\\' ? 1 : 0;
      quoted = c != '"';
    }
    else if (c == '"')
      quoted = true;
    else if (c == '[' || c == '{')
    {
      if (++depth > most)
        return true;
    }
    else if (c == ']' || c == '}')
      --depth;
  }
  return false;
}

} // namespace pcl::cosection
