// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stray_patches.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/depth_edges.h"
#include "point_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection {
namespace {

// Share of a patch's outline on which another surface goes on: of labels of real and rendered scenes, wrong patches
// have 0.65 and more, parts that an occluder cuts off 0.54 and less.
constexpr double mostly = 0.6;
// Length of the outline that borders on readings of other labels, in sides of a square of as many pixels: with less, as
// among missing readings, nothing is known of what is beside a patch.
constexpr double least_side = 1.0;

/** \brief The outline of a patch towards readings of other labels, counted in pairs of pixels. */
struct Outline
{
  std::size_t all = 0;
  std::map<std::uint32_t, std::size_t> continued; // pairs on one surface, by the other's label

  /** \brief The label of the surface that goes on here. \param[in] pixels of the patch */
  std::optional<std::uint32_t> owner (std::size_t pixels) const
  {
    const auto most = std::max_element (continued.begin (), continued.end (),
                                        [] (const auto& a, const auto& b) { return a.second < b.second; });
    const bool is_long = static_cast<double> (all) >= least_side * std::sqrt (static_cast<double> (pixels));
    return is_long && most != continued.end () &&
                   static_cast<double> (most->second) >= mostly * static_cast<double> (all)
               ? std::optional<std::uint32_t> (most->first)
               : std::nullopt;
  }
};

std::vector<Outline>
outlinesOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings,
            const std::vector<std::size_t>& patch_of)
{
  std::vector<Outline> outlines (readings.size ()); // by patch
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
    std::vector<std::size_t> sizes (readings.size (), 0); // by patch
    for (const std::size_t patch : patch_of)
      if (patch != no_patch)
        ++sizes[patch];
    const std::vector<Outline> outlines = outlinesOf (camera, cloud, readings, patch_of);
    std::vector<std::uint32_t> owners (readings.size (), label); // by patch
    const auto main = static_cast<std::size_t> (std::max_element (sizes.begin (), sizes.end ()) - sizes.begin ());
    for (std::size_t patch = 0; patch < owners.size (); ++patch)
      if (patch != main)
        owners[patch] = outlines[patch].owner (sizes[patch]).value_or (label);
    std::size_t count = 0;
    for (std::size_t r = 0; r < readings.size (); ++r)
      if (patch_of[r] != no_patch && owners[patch_of[r]] != label)
      {
        labels[readings[r]] = owners[patch_of[r]];
        ++count;
      }
    if (count > 0)
      moved[label] = static_cast<double> (count) / static_cast<double> (readings.size ());
  }
  cloud.labels = std::move (labels);
  return moved;
}

} // namespace pcl::cosection
