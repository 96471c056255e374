// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "label_patches.h"

#include "pcl_cosection/common/quantile.h"

namespace pcl::cosection {

LabelPatches
patchesOf (const std::vector<Eigen::Vector3f>& points, double reach_m)
{
  LabelPatches patches;
  patches.patch_of = connectedPatches (
      points.size (), [&] (std::size_t p) { return points[p]; }, points.front ().cast<double> (),
      0.5 * reach_m); // neighbours in cells may be twice the width of a cell apart
  patches.sizes.resize (points.size (), 0);
  for (const std::size_t patch : patches.patch_of)
    if (patch != no_patch)
      ++patches.sizes[patch];
  patches.largest = static_cast<std::size_t> (std::max_element (patches.sizes.begin (), patches.sizes.end ()) -
                                              patches.sizes.begin ());
  return patches;
}

LabelPatches
patchesOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings)
{
  const std::vector<Eigen::Vector3f> points = pick (cloud.positions, readings);
  std::vector<float> depths (points.size ());
  std::transform (points.begin (), points.end (), depths.begin (), [] (const auto& p) { return p.z (); });
  const double depth_m = upperMedian (depths);
  return patchesOf (points, largestSurfaceStep (depth_m, depth_m / camera.fx, cloud.working_range_m));
}

} // namespace pcl::cosection
