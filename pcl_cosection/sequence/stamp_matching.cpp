// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stamp_matching.h"

#include "pcl_cosection/common/quantile.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl::cosection {

double
stampPeriod (const std::vector<double>& stamps)
{
  if (stamps.size () < 2)
    return 1.0;
  std::vector<double> differences (stamps.size () - 1);
  for (std::size_t n = 0; n < differences.size (); ++n)
    differences[n] = stamps[n + 1] - stamps[n];
  return upperMedian (differences);
}

std::optional<std::size_t>
nearestStamp (const std::vector<double>& stamps, double stamp, double limit)
{
  auto nearest = std::lower_bound (stamps.begin (), stamps.end (), stamp);
  if (nearest == stamps.end () || (nearest != stamps.begin () && stamp - *(nearest - 1) <= *nearest - stamp))
  {
    if (nearest == stamps.begin ())
      return std::nullopt;
    --nearest;
  }
  if (!(std::abs (*nearest - stamp) < limit))
    return std::nullopt;
  return static_cast<std::size_t> (nearest - stamps.begin ());
}

std::vector<std::optional<Eigen::Isometry3d>>
posesAtStamps (const std::vector<StampedPose>& trajectory, const std::vector<double>& stamps, double period)
{
  if (!(period > 0.0) || !std::isfinite (period))
    throw InvalidArgument ("the period of the frames must be positive, but is " + std::to_string (period));
  std::vector<double> known;
  for (const StampedPose& stamped : trajectory)
    known.push_back (stamped.stamp);
  std::vector<std::optional<Eigen::Isometry3d>> poses (stamps.size ());
  for (std::size_t n = 0; n < stamps.size (); ++n)
    if (const auto nearest = nearestStamp (known, stamps[n], 0.5 * period))
      poses[n] = trajectory[*nearest].pose;
  return poses;
}

std::optional<double>
stampOf (double number)
{
  if (std::abs (number) < 1e15) // whole numbers are exact
    return number;
  if (number > 0.0 && number < 1e16)
    return 1e-6 * number;
  if (number >= 1e18 && number < 1e19)
    return 1e-9 * number;
  return std::nullopt;
}

std::string
stampSpan (double first, double last)
{
  std::ostringstream text;
  text.precision (15);
  text << first << " to " << last;
  return text.str ();
}

} // namespace pcl::cosection
