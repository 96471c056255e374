// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A file and its time, seconds. */
struct StampedFile
{
  double stamp = 0.0;
  std::string name;
};

/** \brief Read a list whose lines are \a columns stamped files; several columns have names without spaces.
 * \throws IoError naming the line */
std::vector<std::vector<StampedFile>> readStampedList (const std::string& path, std::size_t columns);

} // namespace pcl::cosection
