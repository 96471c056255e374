// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stray_patches.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/depth_edges.h"
#include "point_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double mostly = 0.6;     // of the outline
constexpr double least_side = 1.0; // of the outline that borders on others, in sides of a square of as many pixels

/** \brief The outline of a patch towards readings of other labels, counted in pairs of pixels. */
struct Outline
{
  std::size_t all = 0;
  std::map<std::uint32_t, std::size_t> continued; // pairs on one surface, by the other's label
};

/** \brief The largest count; of equals the smallest label. */
std::pair<std::uint32_t, std::size_t>
mostFrequent (const std::map<std::uint32_t, std::size_t>& counts)
{
  return *std::max_element (counts.begin (), counts.end (),
                            [] (const auto& a, const auto& b) { return a.second < b.second; });
}

std::vector<Outline>
outlinesOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings,
            const std::vector<std::size_t>& patch_of, std::size_t patches)
{
  std::vector<Outline> outlines (patches);
  for (std::size_t r = 0; r < readings.size (); ++r)
  {
    if (patch_of[r] == no_patch)
      continue;
    Outline& outline = outlines[patch_of[r]];
    const std::size_t here = readings[r];
    const auto u = static_cast<int> (here % cloud.width), v = static_cast<int> (here / cloud.width);
    const auto visit = [&] (bool inside, std::size_t there) {
      if (!inside || cloud.labels[there] == cloud.labels[here] || !cloud.positions[there].allFinite ())
        return;
      ++outline.all;
      const double a = cloud.positions[here].z (), b = cloud.positions[there].z (), nearer = std::min (a, b);
      if (std::abs (a - b) <= largestSurfaceStep (nearer, nearer / camera.fx))
        ++outline.continued[cloud.labels[there]];
    };
    visit (u > 0, here - 1);
    visit (u + 1 < cloud.width, here + 1);
    visit (v > 0, here - cloud.width);
    visit (v + 1 < cloud.height, here + cloud.width);
  }
  return outlines;
}

} // namespace

std::map<std::uint32_t, double>
relabelStrayPatches (const PinholeCamera& camera, const Members& members, SensorCloud& cloud)
{
  std::map<std::uint32_t, double> moved;
  std::vector<std::uint32_t> labels = cloud.labels;
  for (const auto& [label, readings] : members)
  {
    if (label == 0 || readings.empty ())
      continue;
    const std::vector<Eigen::Vector3f> points = pick (cloud.positions, readings);
    std::vector<float> depths (points.size ());
    std::transform (points.begin (), points.end (), depths.begin (), [] (const auto& p) { return p.z (); });
    const double depth_m = upperMedian (depths);
    // Neighbours in cells may be twice the width of a cell apart.
    const double reach_m = 0.5 * largestSurfaceStep (depth_m, depth_m / camera.fx);
    const std::vector<std::size_t> patch_of = connectedPatches (
        points.size (), [&] (std::size_t p) { return points[p]; }, points.front ().cast<double> (), reach_m);
    std::vector<std::size_t> sizes;
    for (const std::size_t patch : patch_of)
      if (patch != no_patch)
      {
        sizes.resize (std::max (sizes.size (), patch + 1), 0);
        ++sizes[patch];
      }
    const std::vector<Outline> outlines = outlinesOf (camera, cloud, readings, patch_of, sizes.size ());
    const auto main = static_cast<std::size_t> (std::max_element (sizes.begin (), sizes.end ()) - sizes.begin ());
    for (std::size_t r = 0; r < readings.size (); ++r)
    {
      const std::size_t patch = patch_of[r];
      if (patch == no_patch || patch == main || outlines[patch].continued.empty ())
        continue;
      const Outline& outline = outlines[patch];
      const auto [other, count] = mostFrequent (outline.continued);
      if (static_cast<double> (count) < mostly * static_cast<double> (outline.all) ||
          static_cast<double> (outline.all) < least_side * std::sqrt (static_cast<double> (sizes[patch])))
        continue;
      labels[readings[r]] = other;
      moved[label] += 1.0 / static_cast<double> (readings.size ());
    }
  }
  cloud.labels = std::move (labels);
  return moved;
}

} // namespace pcl::cosection
