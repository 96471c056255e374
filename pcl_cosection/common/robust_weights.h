// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/multiversion.h"

#include <algorithm>

namespace pcl::cosection {

// Weights of residuals in iteratively reweighted least squares, 1 for a residual of 0 (P. Huber, "Robust Statistics",
// 1981). A ratio is a residual over the scale beyond which it counts less.

/** \brief Huber's weight of a residual of \a size >= 0: less beyond \a bound > 0. */
template <typename Real>
PCL_COSECTION_INLINE Real
huberWeight (Real size, Real bound)
{
  return size <= bound ? Real (1) : bound / std::max (size, bound); // max: both sides may be computed
}

/** \brief Huber's function of a residual of \a size >= 0: half of its square, and linear beyond \a bound. */
template <typename Real>
PCL_COSECTION_INLINE Real
huberCost (Real size, Real bound)
{
  return size <= bound ? Real (0.5) * size * size : bound * (size - Real (0.5) * bound);
}

/** \brief Cauchy's weight; never 0. */
inline double
cauchyWeight (double ratio)
{
  return 1.0 / (1.0 + ratio * ratio);
}

/** \brief Tukey's weight of a \a ratio in [0, 1]; 0 at the scale. */
inline double
tukeyWeight (double ratio)
{
  return (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
}

} // namespace pcl::cosection
