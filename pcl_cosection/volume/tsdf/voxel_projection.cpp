// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "voxel_projection.h"

#include "pcl_cosection/common/multiversion.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double near_vox = 1e-3;

/** \brief A function of the voxel's number in its row. */
struct Linear
{
  Linear (double at_0, double step) : at_0 (static_cast<float> (at_0)), step (static_cast<float> (step)) {}

  float operator() (float i) const { return at_0 + i * step; }

  float at_0;
  float step;
};

/** \brief A row of voxels before the camera: sensor coordinates, and pixel coordinates (from the image's corner) times
 * z. */
struct ProjectedRow
{
  Linear x, y, z, uz, vz;
  float near_m;
  int width;
  int height;
};

PCL_COSECTION_MULTIVERSION void
findPixels (const ProjectedRow& row, int count, int* __restrict pixels)
{
  const auto width = static_cast<float> (row.width);
  const auto height = static_cast<float> (row.height);
  const int outside = row.width * row.height;
  const ProjectedRow r = row;
  for (int n = 0; n < count; ++n)
  {
    const auto i = static_cast<float> (n);
    const float z = r.z (i);
    const float u = r.uz (i) / z;
    const float v = r.vz (i) / z;
    // A NaN becomes 0 here, so that the conversion is defined for every lane.
    const auto column = static_cast<int> (std::min (std::max (0.0f, u), width - 1.0f));
    const auto line = static_cast<int> (std::min (std::max (0.0f, v), height - 1.0f));
    const bool inside = (z >= r.near_m) & (u >= 0.0f) & (u < width) & (v >= 0.0f) & (v < height);
    pixels[n] = inside ? line * r.width + column : outside;
  }
}

PCL_COSECTION_MULTIVERSION void
measureDistances (const ProjectedRow& row, int count, const float* __restrict readings, const int* __restrict pixels,
                  float* __restrict distances)
{
  const ProjectedRow r = row;
  for (int n = 0; n < count; ++n)
  {
    const auto i = static_cast<float> (n);
    const float x = r.x (i);
    const float y = r.y (i);
    const float z = std::max (r.near_m, r.z (i));
    const float reading = readings[pixels[n]];
    const float distance = (reading - z) * (std::sqrt (x * x + y * y + z * z) / z);
    distances[n] = (reading > 0.0f ? distance : DepthReadings::none);
  }
}

/** \brief A range of real numbers, cut down by conditions. */
struct Interval
{
  double begin;
  double end;

  /** \brief Keep where at_0 + step i >= 0. */
  void keep (double at_0, double step)
  {
    if (step > 0.0)
      begin = std::max (begin, -at_0 / step);
    else if (step < 0.0)
      end = std::min (end, -at_0 / step);
    else if (at_0 < 0.0)
      end = -1.0;
  }
};

} // namespace

VoxelProjection::VoxelProjection (const VoxelGrid& grid, const PinholeCamera& camera,
                                  const Eigen::Isometry3d& T_grid_sensor, const DepthReadings& readings, double reach_m)
    : grid_ (grid)
    , camera_ (camera)
    , readings_ (readings)
    , T_sensor_grid_ (T_grid_sensor.inverse ())
    , step_ (T_sensor_grid_.linear ().col (0) * grid.voxel_size_m)
    , near_m_ (near_vox * grid.voxel_size_m)
    , far_m_ (readings.farthest_m + reach_m)
{}

VoxelRange
VoxelProjection::visible (int j, int k) const
{
  const Eigen::Vector3d p = rowBegin (j, k);
  const double left = camera_.cx + 0.5;
  const double top = camera_.cy + 0.5;
  Interval row{0.0, grid_.dims.x () - 1.0};
  row.keep (p.z () - near_m_, step_.z ());
  row.keep (far_m_ - p.z (), -step_.z ());
  row.keep (camera_.fx * p.x () + left * p.z (), camera_.fx * step_.x () + left * step_.z ());
  row.keep (camera_.fy * p.y () + top * p.z (), camera_.fy * step_.y () + top * step_.z ());
  const double right = camera_.width - left;
  const double bottom = camera_.height - top;
  row.keep (right * p.z () - camera_.fx * p.x (), right * step_.z () - camera_.fx * step_.x ());
  row.keep (bottom * p.z () - camera_.fy * p.y (), bottom * step_.z () - camera_.fy * step_.y ());
  if (!(row.begin <= row.end))
    return {};
  return {static_cast<int> (std::floor (row.begin)), static_cast<int> (std::ceil (row.end)) + 1};
}

void
VoxelProjection::project (int j, int k, const VoxelRange& range, int* pixels, float* distances) const
{
  const Eigen::Vector3d p = rowBegin (j, k) + range.begin * step_;
  const double left = camera_.cx + 0.5;
  const double top = camera_.cy + 0.5;
  const ProjectedRow row{{p.x (), step_.x ()},
                         {p.y (), step_.y ()},
                         {p.z (), step_.z ()},
                         {camera_.fx * p.x () + left * p.z (), camera_.fx * step_.x () + left * step_.z ()},
                         {camera_.fy * p.y () + top * p.z (), camera_.fy * step_.y () + top * step_.z ()},
                         static_cast<float> (near_m_),
                         camera_.width,
                         camera_.height};
  const int count = range.end - range.begin;
  findPixels (row, count, pixels);
  measureDistances (row, count, readings_.depth.data (), pixels, distances);
}

} // namespace pcl::cosection
