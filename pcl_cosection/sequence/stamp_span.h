// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>

namespace pcl::cosection {

/** \brief The range of stamps for messages: "0 to 59". */
inline std::string
stampSpan (double first, double last)
{
  std::ostringstream text;
  text.precision (15);
  text << first << " to " << last;
  return text.str ();
}

} // namespace pcl::cosection
