// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pcl::cosection::test {

/** \brief A text with another part in the place of the first that is \a from, which it must have. */
inline std::string
replaced (std::string text, const std::string& from, const std::string& to)
{
  return (text.replace (text.find (from), from.size (), to));
}

} // namespace pcl::cosection::test
