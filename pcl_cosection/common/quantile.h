// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl::cosection
{

/** \brief The value that a share of all is below. \param[in,out] values not empty; their order changes */
inline double
quantile (std::vector<double>& values, double share)
{
  const auto rank = values.begin () + static_cast<std::ptrdiff_t> (share * static_cast<double> (values.size () - 1));
  std::nth_element (values.begin (), rank, values.end ());
  return *rank;
}

} // namespace pcl::cosection
