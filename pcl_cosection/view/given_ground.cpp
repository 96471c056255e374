// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "given_ground.h"

#include "pcl_cosection/common/boxes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double outlier_share = 0.02;
constexpr double thickest = 0.05;       // of the ground, of the longest side of the cloud, where the search begins
constexpr double reach = 3.0;           // standard deviations
constexpr int rounds = 50;              // at most
constexpr double converged = 0.99;      // of a reach to the one before
constexpr double most_beside = 0.5;     // points as far again beside the ground, of those within
constexpr std::size_t least_left = 100; // points that are not ground

std::size_t
countWithin (const std::vector<double>& heights, double reach)
{
  return static_cast<std::size_t> (
      std::count_if (heights.begin (), heights.end (), [reach] (double h) { return std::abs (h) <= reach; }));
}

/** \brief How far from a plane its points lie: three standard deviations, of which what is farther is left out.
 * \param[in] heights of all points above it \param[in] begin where the search begins \return nothing if the heights
 * have no peak at the plane */
std::optional<double>
reachOfGround (const std::vector<double>& heights, double begin)
{
  double within = begin;
  for (int round = 0; round < rounds; ++round)
  {
    double sum = 0.0, count = 0.0;
    for (const double height : heights)
      if (std::abs (height) <= within)
      {
        sum += height * height;
        ++count;
      }
    const double next = count == 0.0 ? 0.0 : reach * std::sqrt (sum / count);
    if (next >= converged * within)
      break;
    within = next;
  }
  const std::size_t inside = countWithin (heights, within);
  const std::size_t beside = countWithin (heights, 2.0 * within) - inside;
  if (static_cast<double> (beside) > most_beside * static_cast<double> (inside))
    return std::nullopt;
  return within;
}

} // namespace

void
labelGround (const PcdViewOptions& options, SensorCloud& cloud)
{
  if (cloud.has_labels || options.planes.empty ())
    return;
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.positions[i].allFinite ())
      points.push_back (i);
  const double longest = trimmedBox<double> (points, outlier_share, [&] (std::size_t i) { return cloud.positions[i]; })
                             .sizes ()
                             .maxCoeff ();
  const Eigen::Isometry3d T_world_points = Eigen::Translation3d (cloud.origin) * cloud.T_world_sensor;
  for (const auto& [a, b, c, d] : options.planes)
  {
    const Eigen::Vector3d normal (a, b, c);
    std::vector<double> heights;
    for (const std::size_t i : points)
      heights.push_back ((normal.dot (T_world_points * cloud.positions[i].cast<double> ()) + d) / normal.norm ());
    const std::optional<double> ground = reachOfGround (heights, thickest * longest);
    if (!ground || points.size () < least_left + countWithin (heights, *ground))
      continue;
    for (std::size_t k = 0; k < points.size (); ++k)
      if (std::abs (heights[k]) <= *ground)
        cloud.labels[points[k]] = 0;
  }
}

} // namespace pcl::cosection
