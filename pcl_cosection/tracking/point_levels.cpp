// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "point_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

/** \brief Uniform in 32 bits: the finaliser of A. Appleby's MurmurHash3 (public domain). */
std::uint32_t
scrambled (std::uint32_t n)
{
  n ^= n >> 16;
  n *= 0x85ebca6bu;
  n ^= n >> 13;
  n *= 0xc2b2ae35u;
  return n ^ (n >> 16);
}

bool
isUsable (const Eigen::Vector3f& p, float weight)
{
  constexpr float largest = std::numeric_limits<float>::max ();
  return std::abs (p.x ()) <= largest && std::abs (p.y ()) <= largest && std::abs (p.z ()) <= largest &&
         weight > 0.0f && weight <= largest;
}

} // namespace

void
PointLevels::assign (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                     const LevelSizes& sizes)
{
  const auto weightOf = [&] (std::size_t i) { return weights.empty () ? 1.0f : weights[i]; };
  std::size_t usable = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
    usable += isUsable (points[i], weightOf (i));

  // A point belongs to the levels whose threshold is above its number.
  constexpr double range = 4294967296.0;
  const auto expected = static_cast<double> (
      sizes.max_points > 0 ? std::min (usable, static_cast<std::size_t> (sizes.max_points)) : usable);
  std::vector<std::uint64_t> thresholds;
  double level_points = expected;
  for (int level = 0; level < sizes.levels && usable > 0; ++level, level_points /= 4.0)
    if (level == 0 || level_points >= sizes.min_points)
      thresholds.insert (thresholds.begin (),
                         static_cast<std::uint64_t> (range * (level_points / static_cast<double> (usable))));

  constexpr std::uint8_t unusable = 255;
  level_.resize (points.size ());
  std::vector<std::size_t> next (thresholds.size () + 1, 0); // the last: points that are not drawn
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    level_[i] = unusable;
    if (!isUsable (points[i], weightOf (i)))
      continue;
    const std::uint32_t number = scrambled (static_cast<std::uint32_t> (i));
    std::uint8_t level = 0;
    for (const std::uint64_t threshold : thresholds)
      level += number >= threshold;
    level_[i] = level;
    ++next[level];
  }
  ends.clear ();
  std::size_t begin = 0;
  for (std::size_t level = 0; level < thresholds.size (); ++level)
  {
    const std::size_t count = next[level];
    next[level] = begin;
    begin += count;
    ends.push_back (begin);
  }
  for (auto* component : {&x, &y, &z, &weight})
    component->resize (begin);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (level_[i] >= thresholds.size ())
      continue;
    const std::size_t n = next[level_[i]]++;
    x[n] = points[i].x ();
    y[n] = points[i].y ();
    z[n] = points[i].z ();
    weight[n] = weightOf (i);
  }
}

} // namespace pcl::cosection
