// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sensor_noise.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double best_distance = 0.9; // of the working range: there depthNoiseSigma (z) / z is least

} // namespace

double
workingRange (std::vector<float> distances_m)
{
  distances_m.erase (std::remove_if (distances_m.begin (), distances_m.end (),
                                     [] (float distance_m) { return !isReading (distance_m); }),
                     distances_m.end ());
  return distances_m.empty () ? 1.0 : upperMedian (distances_m) / best_distance;
}

double
noiseAt (const Eigen::Vector3d& place, const SensorViews& views)
{
  double least_m = std::numeric_limits<double>::infinity (), noise_m = 0.0;
  for (const auto& [view, T_body_sensor] : views)
  {
    const Eigen::Vector3d seen = T_body_sensor.inverse () * place;
    if (seen.z () < least_m && pixelOf (view->camera, seen))
    {
      least_m = seen.z ();
      noise_m = depthNoiseSigma (least_m, view->working_range_m);
    }
  }
  return noise_m;
}

} // namespace pcl::cosection
