// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "expected_error.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/view/sensor_noise.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double voxel_share = 0.25; // how well a surface is determined between voxel centres

/** \brief Distance of voxel centres to the nearest voxel with a point, metres. */
SignedDistanceField
distanceToPoints (const BodyEnergy& energy, const std::vector<OrientedPoint>& points)
{
  SignedDistanceField distance;
  distance.grid = energy.grid;
  std::vector<std::uint8_t> occupied (energy.grid.size (), 0);
  for (const OrientedPoint& point : points)
    if (const auto at = energy.grid.nearest (point.position.cast<double> ()))
      occupied[energy.grid.index (at->x (), at->y (), at->z ())] = 1;
  distance.values = distanceTransform (energy.grid.dims, occupied, energy.options.threads);
  const auto farthest_vox = static_cast<float> (energy.grid.dims.sum ()); // finite also where there is no point at all
  for (float& value : distance.values)
    value = std::min (value, farthest_vox) * static_cast<float> (energy.grid.voxel_size_m);
  return distance;
}

/** \brief Whether a prior has a target at a voxel around a place. */
bool
hasTarget (const BodyEnergy& energy, const Eigen::Vector3d& place)
{
  if (energy.expects_distance.empty ())
    return false;
  const Eigen::Vector3i lower = energy.grid.toVoxel (place).array ().floor ().cast<int> ();
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3i at = lower + Eigen::Vector3i (corner & 1, (corner >> 1) & 1, corner >> 2);
    if (energy.grid.contains (at.x (), at.y (), at.z ()) &&
        energy.expects_distance[energy.grid.index (at.x (), at.y (), at.z ())])
      return true;
  }
  return false;
}

} // namespace

double
expectedError (const ErrorSources& sources, const SizeShares& shares)
{
  const double share = sources.has_target ? shares.with_target : shares.without;
  const double hidden_m = 0.5 * std::min (sources.data_distance_m, share * sources.size_m);
  return std::hypot (sources.noise_m, voxel_share * sources.voxel_size_m, hidden_m);
}

std::vector<ErrorSources>
errorSources (const BodyEnergy& energy, const std::vector<OrientedPoint>& points, const SensorViews& views,
              double size_m, const TriangleMesh& mesh)
{
  const SignedDistanceField distance = distanceToPoints (energy, points);
  std::vector<ErrorSources> sources (mesh.vertices.size ());
  parallelFor (0, static_cast<int> (sources.size ()), energy.options.threads, [&] (int v) {
    const Eigen::Vector3d place = mesh.vertices[v].cast<double> ();
    const double data_distance_m = distance.sample (place).value_or (std::numeric_limits<float>::infinity ());
    sources[v] = {noiseAt (place, views), energy.grid.voxel_size_m, data_distance_m, size_m, hasTarget (energy, place)};
  });
  return sources;
}

void
attachExpectedErrors (const std::vector<ErrorSources>& sources, TriangleMesh& mesh)
{
  mesh.sigma_m.resize (sources.size ());
  std::transform (sources.begin (), sources.end (), mesh.sigma_m.begin (),
                  [] (const ErrorSources& source) { return static_cast<float> (expectedError (source)); });
}

} // namespace pcl::cosection
