// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Values, one per voxel, with zeros before and behind them: vectorised loops may read over the
 * ends of a row, also of the first and the last. */
template <typename Real> class GuardedField
{
public:
  static constexpr int guard = 16; ///< values that are readable before and behind

  explicit GuardedField (std::size_t size = 0) : values_ (size + 2 * guard, Real (0)) {}

  std::size_t size () const { return values_.size () - 2 * guard; }

  Real* data () { return values_.data () + guard; }

  const Real* data () const { return values_.data () + guard; }

  Real& operator[] (std::size_t n) { return values_[guard + n]; }

private:
  std::vector<Real> values_;
};

} // namespace pcl::cosection
