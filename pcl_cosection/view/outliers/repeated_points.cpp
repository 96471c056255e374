// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "repeated_points.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 100; // of fewer, spacing is no question
constexpr std::size_t samples = 100;
constexpr std::size_t around = 8;    // neighbours; a surface that is not repeated has so many about two steps away
constexpr float much_nearer = 0.05f; // distance to the nearest point, of that to the last of these
constexpr float low_quantile = 0.1f; // of the latter: points may be denser elsewhere
constexpr double many = 0.1;         // share of the samples; by chance, 2 % of random points have one as near

/** \brief Indices of finite points, the first at each place. */
std::vector<std::size_t>
differentPlaces (const std::vector<std::size_t>& indices, const std::vector<Eigen::Vector3f>& positions)
{
  const auto key = [&] (std::size_t i) {
    return std::make_tuple (positions[i].x (), positions[i].y (), positions[i].z ());
  };
  std::vector<std::size_t> order = indices;
  std::sort (order.begin (), order.end (),
             [&] (std::size_t a, std::size_t b) { return std::make_pair (key (a), a) < std::make_pair (key (b), b); });
  order.erase (std::unique (order.begin (), order.end (),
                            [&] (std::size_t a, std::size_t b) { return positions[a] == positions[b]; }),
               order.end ());
  std::sort (order.begin (), order.end ());
  return order;
}

/** \brief Distances to the nearest neighbour of a point, and to the last of those around it. */
std::pair<float, float>
distancesAround (const std::vector<Eigen::Vector3f>& points, std::size_t p)
{
  std::array<float, around> nearest;
  nearest.fill (std::numeric_limits<float>::infinity ());
  for (std::size_t q = 0; q < points.size (); ++q)
    if (const float squared = (points[q] - points[p]).squaredNorm (); squared < nearest.back () && q != p)
    {
      nearest.back () = squared;
      for (std::size_t n = around - 1; n > 0 && nearest[n] < nearest[n - 1]; --n)
        std::swap (nearest[n], nearest[n - 1]);
    }
  return {std::sqrt (nearest.front ()), std::sqrt (nearest.back ())};
}

/** \brief How near points are that repeat others; 0 if none do. */
float
reachOfRepeats (const std::vector<Eigen::Vector3f>& points, int threads)
{
  std::array<std::pair<float, float>, samples> distances;
  parallelFor (0, static_cast<int> (samples), threads,
               [&] (int s) { distances[s] = distancesAround (points, s * points.size () / samples); });
  std::vector<float> reach;
  for (const auto& [nearest, last] : distances)
    if (nearest < much_nearer * last)
      reach.push_back (much_nearer * last);
  return static_cast<double> (reach.size ()) < many * samples ? 0.0f : quantile (reach, low_quantile);
}

/** \brief Of points nearer to each other than \a reach_m, the first. */
std::vector<std::size_t>
firstOfNear (const std::vector<std::size_t>& indices, const std::vector<Eigen::Vector3f>& positions, float reach_m)
{
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> kept_in; // by cell
  std::vector<std::size_t> kept;
  const Eigen::Vector3f& middle = positions[indices[indices.size () / 2]];
  for (const std::size_t i : indices)
  {
    const auto cell = cellOf ((positions[i] - middle).cast<double> () / reach_m);
    bool repeats = false;
    for (int n = 0; n < 27 && cell && !repeats; ++n)
      if (const auto there = kept_in.find (keyOf (neighbourOf (*cell, n))); there != kept_in.end ())
        repeats = std::any_of (there->second.begin (), there->second.end (),
                               [&] (std::size_t j) { return (positions[i] - positions[j]).norm () < reach_m; });
    if (repeats)
      continue;
    kept.push_back (i);
    if (cell)
      kept_in[keyOf (*cell)].push_back (i);
  }
  return kept;
}

} // namespace

std::vector<std::size_t>
withoutRepeated (const std::vector<std::size_t>& indices, const std::vector<Eigen::Vector3f>& positions, int threads)
{
  std::vector<std::size_t> kept = differentPlaces (indices, positions);
  if (kept.size () >= least_points)
  {
    std::vector<Eigen::Vector3f> places;
    for (const std::size_t i : kept)
      places.push_back (positions[i]);
    if (const float reach_m = reachOfRepeats (places, threads); reach_m > 0.0f)
      kept = firstOfNear (kept, positions, reach_m);
  }
  return kept;
}

double
leaveOutRepeated (int threads, SensorCloud& cloud)
{
  std::size_t all = 0, left = 0;
  for (const auto& [label, indices] : membersOf (cloud))
  {
    const std::vector<std::size_t> kept = withoutRepeated (indices, cloud.positions, threads);
    all += indices.size ();
    left += kept.size ();
    auto next = kept.begin ();
    for (const std::size_t i : indices)
      if (next != kept.end () && *next == i)
        ++next;
      else
        cloud.positions[i].setConstant (nan_value);
  }
  return all == 0 ? 0.0 : static_cast<double> (all - left) / static_cast<double> (all);
}

} // namespace pcl::cosection
