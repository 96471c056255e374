// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl::cosection {

// Every function here takes values that are finite and at least one, and is O (values) unless it says more. The values'
// order changes.

/** \brief The value at place \a rank, from 0, if the values were sorted. */
template <typename Real>
Real
valueOfRank (std::vector<Real>& values, std::size_t rank)
{
  const auto place = values.begin () + static_cast<std::ptrdiff_t> (rank);
  std::nth_element (values.begin (), place, values.end ());
  return *place;
}

/** \brief The value that a \a share in [0, 1] of the others is not above: the lower one of two. */
template <typename Real>
Real
quantile (std::vector<Real>& values, double share)
{
  return valueOfRank (values, static_cast<std::size_t> (share * static_cast<double> (values.size () - 1)));
}

/** \brief The value in the middle: the upper one of two. */
template <typename Real>
Real
upperMedian (std::vector<Real>& values)
{
  return valueOfRank (values, values.size () / 2);
}

/** \brief The value in the middle, the mean of two if there are two. O (values log values). */
template <typename Real>
Real
median (std::vector<Real>& values)
{
  std::sort (values.begin (), values.end ());
  return Real (0.5) * (values[(values.size () - 1) / 2] + values[values.size () / 2]);
}

/** \brief Standard deviation of normally distributed errors, from their \a sizes: robust, as half of them may be
 * outliers. */
template <typename Real>
Real
sigmaOfSizes (std::vector<Real>& sizes)
{
  return Real (1.4826) * upperMedian (sizes);
}

/** \brief How many values are left out at one end of \a count values, for a \a share of outliers in [0, 0.5). */
inline std::size_t
outlierCount (std::size_t count, double share)
{
  return static_cast<std::size_t> (share * static_cast<double> (count));
}

/** \brief The least value without a \a share of outliers in [0, 0.5). */
template <typename Real>
Real
trimmedMin (std::vector<Real>& values, double share)
{
  return valueOfRank (values, outlierCount (values.size (), share));
}

/** \brief The largest value without a \a share of outliers in [0, 0.5). */
template <typename Real>
Real
trimmedMax (std::vector<Real>& values, double share)
{
  return valueOfRank (values, values.size () - 1 - outlierCount (values.size (), share));
}

} // namespace pcl::cosection
