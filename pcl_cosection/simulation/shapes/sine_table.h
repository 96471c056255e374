// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace pcl::cosection {

/** \brief Sine and cosine at 4096 angles, for pixels: noise and patterns need no more, and libm's take most of a frame.
 */
class SineTable
{
public:
  SineTable ()
  {
    for (std::uint32_t n = 0; n < size; ++n)
      sine_[n] = std::sin (2.0 * M_PI * n / size);
  }

  /** \param[in] turns angle, of any size that a 64-bit integer holds; 1 is a revolution */
  double sine (double turns) const
  {
    return sine_[static_cast<std::uint64_t> (static_cast<std::int64_t> (std::floor (turns * size + 0.5))) % size];
  }

  double cosine (double turns) const { return sine (turns + 0.25); }

private:
  static constexpr std::uint32_t size = 4096;
  std::array<double, size> sine_;
};

/** \brief The one table. */
inline const SineTable&
sineTable ()
{
  static const SineTable table;
  return table;
}

} // namespace pcl::cosection
