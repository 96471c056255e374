// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace pcl::cosection
{

/** \brief The values that would be at two places if \a values were sorted: exactly, and fast if there are many.
 * \param[in] values finite; not empty */
template <typename Real>
std::array<Real, 2>
valuesOfRanks (const std::vector<Real>& values, const std::array<std::size_t, 2>& ranks)
{
  constexpr int bins = 1024;
  Real low = values.front ();
  Real high = values.front ();
  for (const Real value : values)
  {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  const Real per_value = high > low ? Real (bins) / (high - low) : Real (0);
  const auto bin = [&] (Real value) { // larger values are in no lower bin, however this is rounded
    const Real place = (value - low) * per_value;
    return place > Real (0) ? static_cast<int> (std::min (place, Real (bins - 1))) : 0;
  };
  std::array<std::size_t, bins> counts{};
  for (const Real value : values)
    ++counts[bin (value)];
  std::array<Real, 2> found{};
  std::vector<Real> candidates;
  for (int r = 0; r < 2; ++r)
  {
    int wanted = 0;
    std::size_t before = 0;
    while (before + counts[wanted] <= ranks[r])
      before += counts[wanted++];
    candidates.clear ();
    for (const Real value : values)
      if (bin (value) == wanted)
        candidates.push_back (value);
    const auto at = candidates.begin () + static_cast<std::ptrdiff_t> (ranks[r] - before);
    std::nth_element (candidates.begin (), at, candidates.end ());
    found[r] = *at;
  }
  return found;
}

} // namespace pcl::cosection
