// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/volume/rigid_motion.h"
#include "voxel_projection.h"

#include "pcl_cosection/common/multiversion.h"

#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace pcl::cosection {
namespace {

/** \brief Voxels so near to a reading take its colour: those that the colour of a vertex is interpolated from, also
 * where the ray grazes the surface. */
constexpr double colour_band_vox = 3.0;

constexpr float fixed_point = 256.0f; ///< of ColourVoxel
constexpr float max_fixed_point = std::numeric_limits<std::uint16_t>::max ();

template <typename Pixel>
void
checkSize (const Image<Pixel>& image, const PinholeCamera& camera, const char* what)
{
  if (image.width != camera.width || image.height != camera.height ||
      image.pixels.size () != static_cast<std::size_t> (camera.width) * camera.height)
    throw InvalidArgument (std::string ("TSDF volume: the ") + what + " must be of the camera's size");
}

void
checkView (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor)
{
  camera.validate ();
  if (static_cast<long long> (camera.width) * camera.height >= std::numeric_limits<int>::max ())
    throw InvalidArgument ("TSDF volume: the image has more pixels than can be counted");
  checkSize (depth, camera, "depth image");
  if (!isRigidMotion (T_grid_sensor))
    throw InvalidArgument ("TSDF volume: the sensor's pose must be a finite rigid motion");
}

/** \brief The readings of the pixels i for which use (i). */
template <typename Use>
DepthReadings
collectReadings (const Image<float>& depth, int threads, Use&& use)
{
  DepthReadings readings;
  readings.depth.resize (depth.pixels.size () + 1, DepthReadings::none);
  std::vector<float> farthest_m (depth.height, 0.0f);
  parallelFor (0, depth.height, threadsForVoxels (threads, depth.pixels.size ()), [&] (int v) {
    const std::size_t begin = static_cast<std::size_t> (v) * depth.width;
    float farthest = 0.0f;
    for (std::size_t i = begin; i < begin + depth.width; ++i)
    {
      const float z = depth.pixels[i];
      const bool used = z > 0.0f && z <= std::numeric_limits<float>::max () && use (i);
      readings.depth[i] = used ? z : DepthReadings::none;
      farthest = std::max (farthest, readings.depth[i]);
    }
    farthest_m[v] = farthest;
  });
  readings.farthest_m = *std::max_element (farthest_m.begin (), farthest_m.end ());
  return readings;
}

/** \brief Call visit (first voxel, distances, pixels, count) for each row of voxels that has some in view.
 * \param[in] reach_m how far behind a reading voxels are of interest
 *
 * Slices are dealt out in strides, so that each thread gets near and far ones. */
template <typename Visit>
void
forEachVisibleRow (const VoxelGrid& grid, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                   const DepthReadings& readings, double reach_m, int threads, Visit&& visit)
{
  if (!(readings.farthest_m > 0.0f))
    return;
  const VoxelProjection projection (grid, camera, T_grid_sensor, readings, reach_m);
  const int slices = grid.dims.z ();
  int stride = std::max (1, static_cast<int> (0.618 * slices));
  while (std::gcd (stride, slices) != 1)
    ++stride;
  parallelChunks (0, slices, threadsForVoxels (threads, grid.size ()), [&] (int first, int last) {
    std::vector<int> pixels (grid.dims.x ());
    std::vector<float> distances (grid.dims.x ());
    for (int n = first; n < last; ++n)
    {
      const auto k = static_cast<int> (static_cast<long long> (n) * stride % slices);
      for (int j = 0; j < grid.dims.y (); ++j)
      {
        const VoxelRange range = projection.visible (j, k);
        const int count = range.end - range.begin;
        if (count <= 0)
          continue;
        projection.project (j, k, range, pixels.data (), distances.data ());
        visit (grid.index (range.begin, j, k), distances.data (), pixels.data (), count);
      }
    }
  });
}

/** \brief KinectFusion's Equations (11) to (13), for a row of voxels.
 * \param[in] pixel_weights not looked at if all are 1
 * \param[in] least_m voxels of smaller distances learn nothing */
template <bool weighted>
PCL_COSECTION_INLINE void
average (const float* __restrict distances, const int* __restrict pixels, const float* __restrict pixel_weights,
         float least_m, float truncation_m, float max_weight, int count, float* __restrict values,
         float* __restrict weights)
{
  for (int n = 0; n < count; ++n)
  {
    const float d = distances[n];
    const float of_pixel = (weighted ? pixel_weights[pixels[n]] : 1.0f);
    const float w = (d >= least_m ? of_pixel : 0.0f);
    const float old_weight = weights[n];
    const float old_value = values[n];
    const float base = (old_weight > 0.0f ? old_value : 0.0f);
    const float total = old_weight + w;
    const float mean = base + (std::min (d, truncation_m) - base) * (w / total);
    values[n] = (w > 0.0f ? mean : old_value);
    weights[n] = std::min (total, max_weight);
  }
}

PCL_COSECTION_MULTIVERSION void
averageRow (const float* distances, const int* pixels, float least_m, float truncation_m, float max_weight, int count,
            float* values, float* weights)
{
  average<false> (distances, pixels, nullptr, least_m, truncation_m, max_weight, count, values, weights);
}

PCL_COSECTION_MULTIVERSION void
averageWeightedRow (const float* distances, const int* pixels, const float* pixel_weights, float truncation_m,
                    float max_weight, int count, float* values, float* weights)
{
  average<true> (distances, pixels, pixel_weights, -truncation_m, truncation_m, max_weight, count, values, weights);
}

} // namespace

void
TsdfVolume::integrate (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                       const TsdfPixels& pixels)
{
  checkView (depth, camera, T_grid_sensor);
  if (pixels.weights)
    checkSize (*pixels.weights, camera, "image of weights");
  if (pixels.labels)
    checkSize (*pixels.labels, camera, "image of labels");
  if (pixels.colours)
    checkSize (*pixels.colours, camera, "colour image");

  const auto max_weight = static_cast<float> (options_.max_weight);
  std::vector<float> pixel_weights; // with one more for voxels without a pixel
  if (pixels.weights)
  {
    pixel_weights.assign (depth.pixels.size () + 1, 0.0f);
    for (std::size_t i = 0; i < depth.pixels.size (); ++i)
      pixel_weights[i] = std::min (std::max (0.0f, pixels.weights->pixels[i]), max_weight); // NaN: 0
  }
  const DepthReadings readings = collectReadings (depth, options_.threads, [&] (std::size_t i) {
    const bool labelled = !pixels.labels || pixels.labels->pixels[i] == pixels.label;
    return labelled && (pixel_weights.empty () || pixel_weights[i] > 0.0f);
  });
  const bool with_colour = pixels.colours && options_.colour;
  const auto truncation_m = static_cast<float> (truncation ());
  const float* weight_of_pixel = (pixel_weights.empty () ? nullptr : pixel_weights.data ());
  forEachVisibleRow (
      grid (), camera, T_grid_sensor, readings, truncation (), options_.threads,
      [&] (std::size_t voxel, const float* distances, const int* indices, int count) {
        float* values = &field_.values[voxel];
        float* weights = &weights_[voxel];
        if (weight_of_pixel)
          averageWeightedRow (distances, indices, weight_of_pixel, truncation_m, max_weight, count, values, weights);
        else
          averageRow (distances, indices, -truncation_m, truncation_m, max_weight, count, values, weights);
        if (with_colour)
          averageColours (voxel, distances, indices, count, weight_of_pixel, *pixels.colours);
      });
}

void
TsdfVolume::integrateFreeSpace (const Image<float>& depth, const PinholeCamera& camera,
                                const Eigen::Isometry3d& T_grid_sensor, const Image<std::uint16_t>& labels,
                                std::uint16_t label)
{
  checkView (depth, camera, T_grid_sensor);
  checkSize (labels, camera, "image of labels");
  const DepthReadings readings = collectReadings (depth, options_.threads,
                                                  [&] (std::size_t i) { return labels.pixels[i] != label; });
  const auto truncation_m = static_cast<float> (truncation ());
  const auto max_weight = static_cast<float> (options_.max_weight);
  forEachVisibleRow (grid (), camera, T_grid_sensor, readings, 0.0, options_.threads,
                     [&] (std::size_t voxel, const float* distances, const int* indices, int count) {
                       averageRow (distances, indices, truncation_m, truncation_m, max_weight, count,
                                   &field_.values[voxel], &weights_[voxel]);
                     });
}

void
TsdfVolume::forget (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                    const Image<std::uint16_t>& labels, std::uint16_t label)
{
  checkView (depth, camera, T_grid_sensor);
  checkSize (labels, camera, "image of labels");
  const DepthReadings readings = collectReadings (depth, options_.threads,
                                                  [&] (std::size_t i) { return labels.pixels[i] == label; });
  const auto band_m = static_cast<float> (truncation ());
  forEachVisibleRow (grid (), camera, T_grid_sensor, readings, truncation (), options_.threads,
                     [&] (std::size_t voxel, const float* distances, const int*, int count) {
                       for (int n = 0; n < count; ++n)
                         if (std::abs (distances[n]) <= band_m)
                         {
                           field_.values[voxel + n] = std::numeric_limits<float>::quiet_NaN ();
                           weights_[voxel + n] = 0.0f;
                         }
                     });
}

void
TsdfVolume::averageColours (std::size_t first_voxel, const float* distances, const int* pixels, int count,
                            const float* pixel_weights, const Picture& colours)
{
  const auto band_m = static_cast<float> (std::min (colour_band_vox, options_.truncation_vox) * grid ().voxel_size_m);
  const float max_weight = std::min (static_cast<float> (options_.max_weight), max_fixed_point / fixed_point);
  for (int n = 0; n < count; ++n)
  {
    if (!(std::abs (distances[n]) <= band_m))
      continue;
    ColourVoxel& voxel = colours_[first_voxel + n];
    const float w = (pixel_weights ? pixel_weights[pixels[n]] : 1.0f);
    const float total = voxel.weight / fixed_point + w;
    const auto& colour = colours.pixels[pixels[n]];
    for (int channel = 0; channel < 3; ++channel)
    {
      const float old = voxel.rgb[channel];
      const float mean = old + (fixed_point * colour[channel] - old) * (w / total);
      voxel.rgb[channel] = static_cast<std::uint16_t> (mean + 0.5f);
    }
    // At least one unit: a voxel that has a colour says so.
    voxel.weight = static_cast<std::uint16_t> (std::max (1.0f, fixed_point * std::min (total, max_weight) + 0.5f));
  }
}

void
TsdfVolume::countForeground (const Image<float>& depth, const PinholeCamera& camera,
                             const Eigen::Isometry3d& T_grid_sensor, const Image<std::uint16_t>& labels,
                             std::uint16_t label)
{
  if (!options_.foreground)
    throw InvalidArgument ("TSDF volume: it was made without foreground counts");
  checkView (depth, camera, T_grid_sensor);
  checkSize (labels, camera, "image of labels");
  const DepthReadings readings = collectReadings (depth, options_.threads, [] (std::size_t) { return true; });
  forEachVisibleRow (grid (), camera, T_grid_sensor, readings, truncation (), options_.threads,
                     [&] (std::size_t voxel, const float* distances, const int* indices, int count) {
                       countLabels (voxel, distances, indices, count, labels, label);
                     });
}

void
TsdfVolume::countLabels (std::size_t first_voxel, const float* distances, const int* pixels, int count,
                         const Image<std::uint16_t>& labels, std::uint16_t label)
{
  const auto band_m = static_cast<float> (truncation ());
  for (int n = 0; n < count; ++n)
  {
    if (!(std::abs (distances[n]) <= band_m))
      continue;
    LabelCounts& counts = counts_[first_voxel + n];
    std::uint16_t& seen = (labels.pixels[pixels[n]] == label ? counts.foreground : counts.background);
    if (++seen == std::numeric_limits<std::uint16_t>::max ())
    {
      counts.foreground /= 2;
      counts.background /= 2;
    }
  }
}

} // namespace pcl::cosection
