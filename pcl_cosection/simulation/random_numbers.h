// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Random numbers that are the same with every standard library. */
class RandomNumbers
{
public:
  explicit RandomNumbers (std::uint64_t seed) : engine_ (seed) {}

  /** \brief A seed for other random numbers. */
  std::uint64_t seed () { return engine_ (); }

  double in (double low, double high) { return low + (high - low) * static_cast<double> (engine_ () >> 11) * 0x1p-53; }

  /** \brief Its logarithm is uniform. */
  double logIn (double low, double high) { return low * std::pow (high / low, in (0.0, 1.0)); }

  bool chance (double probability) { return in (0.0, 1.0) < probability; }

  /** \brief 0 to \a count - 1. */
  int below (int count) { return static_cast<int> (in (0.0, count)); }

  /** \brief Of the standard normal distribution (Box and Muller). */
  double normal ()
  {
    const double radius = std::sqrt (-2.0 * std::log (1.0 - in (0.0, 1.0)));
    return radius * std::cos (2.0 * M_PI * in (0.0, 1.0));
  }

  std::vector<std::size_t> permutation (std::size_t count)
  {
    std::vector<std::size_t> order (count);
    std::iota (order.begin (), order.end (), 0);
    for (std::size_t n = count; n > 1; --n)
      std::swap (order[n - 1], order[engine_ () % n]);
    return order;
  }

private:
  std::mt19937_64 engine_;
};

} // namespace pcl::cosection
