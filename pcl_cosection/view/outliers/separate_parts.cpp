// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "separate_parts.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/labels/label_patches.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

namespace pcl::cosection {
namespace {

/** \brief How much may be wrong of what is so far apart. */
struct Limit
{
  double reach; // in largest steps of a surface
  double share; // of the points
};

// Little that is apart, or more that is farther: in 17 real things that were cut out by masks, up to .09 are of what is
// behind them, but of one .13; scanned things that are seen in pieces, such as racks and book ends, have .13 near the
// rest. Mean accuracy of the real ones 7.3 mm with the first limit alone, 6.0 mm with the second one, too.
constexpr std::array<Limit, 2> limits = {{{1.0, 0.1}, {2.0, 0.3}}};

} // namespace

double
leaveOutSeparateParts (const PcdViewOptions& options, const std::vector<std::size_t>& indices, SensorCloud& cloud)
{
  std::vector<std::size_t> usable;
  std::copy_if (indices.begin (), indices.end (), std::back_inserter (usable),
                [&] (std::size_t i) { return cloud.normals[i].allFinite (); });
  if (usable.size () < 2)
    return 0.0;
  const std::vector<Eigen::Vector3f> points = pick (cloud.positions, usable);
  std::vector<float> spacings_m = neighbourDistances (points, 1, options.threads);
  std::vector<float> ranges_m (points.size ());
  std::transform (points.begin (), points.end (), ranges_m.begin (), [] (const auto& point) { return point.norm (); });
  const double step_m = largestSurfaceStep (upperMedian (ranges_m), upperMedian (spacings_m), cloud.working_range_m);
  for (const Limit& limit : limits)
  {
    const LabelPatches patches = patchesOf (points, limit.reach * step_m);
    const double apart = 1.0 -
                         static_cast<double> (patches.sizes[patches.largest]) / static_cast<double> (indices.size ());
    if (apart > limit.share)
      continue;
    for (std::size_t k = 0; k < usable.size (); ++k)
      if (patches.patch_of[k] != patches.largest)
        cloud.normals[usable[k]].setConstant (std::numeric_limits<float>::quiet_NaN ());
    return apart;
  }
  return 0.0;
}

} // namespace pcl::cosection
