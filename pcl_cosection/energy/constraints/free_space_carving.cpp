// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "free_space_carving.h"

#include "pcl_cosection/view/visibility/projected_voxels.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int window = 4;        // pixels around a projection in which the boundary is looked for
constexpr double inset_px = 1.0; // the cut lies so far inside the silhouette, as pixels at a depth edge say nothing
constexpr float far_vox = 3.0f;  // distances are clamped to this
// A cut by one view of several is made so much farther out than one that four views support.
constexpr float single_view_offset_vox = 0.6f;

} // namespace

FreeSpaceCarving::FreeSpaceCarving (const VoxelGrid& grid, bool revise, int threads)
    : grid_ (grid)
    , revise_ (revise)
    , threads_ (threads)
    , bound_vox_ (grid.size ())
    , inside_vox_ (grid.size (), nothing)
    , votes_for_ (grid.size (), 0)
    , votes_against_ (grid.size (), 0)
{}

void
FreeSpaceCarving::Supported::add (float value)
{
  for (float& kept : largest)
    if (value > kept)
      std::swap (value, kept);
}

float
FreeSpaceCarving::Supported::value (float offset_vox) const
{
  float best = nothing;
  for (int views = 1; views <= full_support; ++views)
    best = std::max (best,
                     largest[views - 1] - offset_vox * static_cast<float> (full_support - views) / (full_support - 1));
  return best;
}

void
FreeSpaceCarving::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor)
{
  ++views_;
  const PinholeCamera& camera = view.view ().camera;
  const std::vector<float>& opened = view.openedDepth ();
  const PixelRegion region = projectedRegion (grid_, camera, T_grid_sensor);
  const std::vector<float> lowest = filterDepth (opened, camera, window, false, region);
  const std::vector<float> highest = filterDepth (opened, camera, window, true, region);
  const double focal = 0.5 * (camera.fx + camera.fy);

  forEachProjectedVoxel (grid_, camera, T_grid_sensor, threads_, [&] (const ProjectedVoxel& voxel) {
    const float reach = static_cast<float> (voxel.z + freeSpaceMargin (voxel.z, grid_.voxel_size_m));
    if (highest[voxel.pixel] <= reach)
      return; // nothing free near
    const double voxels_per_pixel = voxel.z / focal / grid_.voxel_size_m;
    const bool free_here = opened[voxel.pixel] > reach;
    double squared_px = window * window; // to the nearest pixel of the other kind
    if (!free_here || lowest[voxel.pixel] <= reach)
      for (int v = std::max (0, voxel.row - window); v <= std::min (camera.height - 1, voxel.row + window); ++v)
      {
        const double down = std::max (0.0, std::abs (voxel.v - v) - 0.5);
        if (down * down >= squared_px)
          continue;
        const float* row = opened.data () + static_cast<std::size_t> (v) * camera.width;
        for (int u = std::max (0, voxel.column - window); u <= std::min (camera.width - 1, voxel.column + window); ++u)
          if ((row[u] > reach) != free_here)
          {
            const double across = std::max (0.0, std::abs (voxel.u - u) - 0.5);
            squared_px = std::min (squared_px, across * across + down * down);
          }
      }
    const double distance_px = std::sqrt (squared_px);
    const auto signed_vox = static_cast<float> (((free_here ? distance_px : -distance_px) + inset_px) *
                                                voxels_per_pixel);
    const std::size_t n = voxel.index;
    if (signed_vox > -far_vox)
      bound_vox_[n].add (signed_vox);
    if (signed_vox > 0.0f)
    {
      if (votes_for_[n] < 255)
        ++votes_for_[n];
    }
    else
      inside_vox_[n] = std::max (inside_vox_[n], signed_vox);
    const float depth = view.view ().depth[voxel.pixel];
    if (!free_here && std::abs (depth - voxel.z) <= reach - voxel.z && votes_against_[n] < 255)
      ++votes_against_[n];
  });
}

std::vector<float>
FreeSpaceCarving::lowerBounds (bool offset_any) const
{
  const float offset_vox = offset_any || views_ > 1 ? single_view_offset_vox : 0.0f;
  std::vector<float> bounds (bound_vox_.size ());
  for (std::size_t n = 0; n < bounds.size (); ++n)
  {
    // One or two views cannot outvote each other.
    const int needed = revise_ && votes_for_[n] + votes_against_[n] > 2 ? votes_against_[n] : 0;
    const float bound = votes_for_[n] > needed ? bound_vox_[n].value (offset_vox)
                                               : std::min (inside_vox_[n], bound_vox_[n].value (offset_vox));
    bounds[n] = std::clamp (bound, -far_vox, far_vox);
  }

  // A binomial filter removes the staircase of the pixels.
  std::vector<float> smooth (bounds.size ());
  parallelFor (0, grid_.dims.z (), threads_, [&] (int k) {
    for (int j = 0; j < grid_.dims.y (); ++j)
      for (int i = 0; i < grid_.dims.x (); ++i)
      {
        const std::size_t n = grid_.index (i, j, k);
        smooth[n] = bounds[n];
        if (std::abs (bounds[n]) >= far_vox || !grid_.contains (i - 1, j - 1, k - 1) ||
            !grid_.contains (i + 1, j + 1, k + 1))
          continue;
        float sum = 0.0f;
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              sum += static_cast<float> ((2 - std::abs (dx)) * (2 - std::abs (dy)) * (2 - std::abs (dz))) *
                     bounds[grid_.index (i + dx, j + dy, k + dz)];
        smooth[n] = sum / 64.0f;
      }
  });
  return smooth;
}

} // namespace pcl::cosection
