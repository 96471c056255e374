// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hull_constraint.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/least_wall.h"
#include "pcl_cosection/view/visibility/projected_voxels.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int max_footprint = 12; // pixels
constexpr int window = 4;         // pixels around a projection in which the boundary is looked for
constexpr double inset_px = 1.0;  // the cut lies so far inside the silhouette, as pixels at a depth edge say nothing
constexpr float far_vox = 3.0f;   // distances are clamped to this
// A cut by one view of several is made so much farther out than one that four views support.
constexpr float single_view_offset_vox = 0.6f;

void
vote (std::uint8_t& votes)
{
  if (votes < 255)
    ++votes;
}

/** \brief Bands in an image: what is nearer than a depth, but no block of pixels is. */
class Bands
{
public:
  Bands (const std::vector<float>& depth, const PinholeCamera& camera, const PixelRegion& region)
  {
    for (int radius = 1; radius <= static_cast<int> (closed_.size ()); ++radius)
      closed_[radius - 1] = filterDepth (filterDepth (depth, camera, radius, true, region), camera, radius, false,
                                         region);
  }

  /** \brief Half the width of the band at a pixel, pixels; infinity where there is none. */
  double halfWidth (std::size_t pixel, float depth) const
  {
    for (std::size_t n = 0; n < closed_.size (); ++n)
      if (closed_[n][pixel] > depth)
        return static_cast<double> (n) + 0.75; // the mean of bands of 1 and 2 pixels, and of 3 and 4
    return std::numeric_limits<double>::infinity ();
  }

private:
  std::array<std::vector<float>, 2> closed_; // without bands of less than 3 and 5 pixels
};

struct OtherPixel
{
  std::size_t pixel;
  double squared_px; // from the projection of a voxel, to the pixel's border
};

/** \brief Around the projection of a voxel, the nearest pixel that is free at the voxel's depth; or, if the voxel's own
 * is, the nearest that is not. If there is none: its own, and the window's size. */
OtherPixel
nearestOther (const std::vector<float>& depth, const PinholeCamera& camera, const ProjectedVoxel& voxel, bool free_here)
{
  OtherPixel nearest{voxel.pixel, window * window};
  for (int v = std::max (0, voxel.row - window); v <= std::min (camera.height - 1, voxel.row + window); ++v)
  {
    const double down = std::max (0.0, std::abs (voxel.v - v) - 0.5);
    if (down * down >= nearest.squared_px)
      continue;
    const std::size_t row = static_cast<std::size_t> (v) * camera.width;
    for (int u = std::max (0, voxel.column - window); u <= std::min (camera.width - 1, voxel.column + window); ++u)
      if ((depth[row + u] > static_cast<float> (voxel.z)) != free_here)
      {
        const double across = std::max (0.0, std::abs (voxel.u - u) - 0.5);
        if (across * across + down * down < nearest.squared_px)
          nearest = {row + u, across * across + down * down};
      }
  }
  return nearest;
}

} // namespace

HullConstraint::HullConstraint (const VoxelGrid& grid, const VoxelGrid& whole, int threads)
    : grid_ (grid)
    , whole_ (whole)
    , threads_ (threads)
    , votes_for_ (grid.size (), 0)
    , votes_against_ (grid.size (), 0)
{}

void
HullConstraint::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, int body)
{
  const PinholeCamera& camera = view.view ().camera;
  const Eigen::Isometry3d T_sensor_grid = T_grid_sensor.inverse ();

  const PixelRegion region = projectedRegion (grid_, camera, T_grid_sensor);
  const std::vector<Eigen::Vector3d> own = corners (grid_);
  const bool is_behind = std::all_of (
      own.begin (), own.end (), [&] (const Eigen::Vector3d& corner) { return !((T_sensor_grid * corner).z () > 0.0); });
  if (is_behind || region.left >= region.right || region.top >= region.bottom)
    return;

  // The footprint at the nearest corner of the volume serves all its voxels.
  double nearest = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3d& corner : corners (whole_))
    nearest = std::min (nearest, (T_sensor_grid * corner).z ());
  const double focal = std::max (camera.fx, camera.fy);
  const double half_diagonal = 0.5 * std::sqrt (3.0) * grid_.voxel_size_m;
  const int radius = nearest > half_diagonal
                         ? std::min (max_footprint, static_cast<int> (std::ceil (half_diagonal * focal / nearest)))
                         : max_footprint;
  const std::vector<float> free_depth = filterDepth (view.freeDepth (view.view ().depth, body, grid_.voxel_size_m,
                                                                     std::numeric_limits<float>::infinity (),
                                                                     grown (region, radius, camera)),
                                                     camera, radius, false, region);

  forEachProjectedVoxel (grid_, camera, T_grid_sensor, threads_, [&] (const ProjectedVoxel& voxel) {
    const float depth = view.view ().depth[voxel.pixel];
    const double margin = freeSpaceMargin (view.view (), depth, grid_.voxel_size_m);
    const PointVisibility visibility = compareWithReading (voxel.z, depth, margin);
    if (visibility == PointVisibility::NoReading || visibility == PointVisibility::Occluded)
      return;
    if (!view.atEdge (voxel.column, voxel.row) && free_depth[voxel.pixel] > voxel.z)
      vote (votes_for_[voxel.index]);
    else if (visibility == PointVisibility::AtSurface && !view.showsOther (voxel.pixel, body))
      vote (votes_against_[voxel.index]);
  });
}

std::vector<std::uint8_t>
HullConstraint::freeSpace (bool revise) const
{
  std::vector<std::uint8_t> free_space (votes_for_.size ());
  const std::size_t plane = static_cast<std::size_t> (grid_.dims.x ()) * grid_.dims.y ();
  parallelFor (0, grid_.dims.z (), threads_, [&] (int k) {
    for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
      free_space[n] = votes_for_[n] > (revise ? votes_against_[n] : 0);
  });
  return free_space;
}

std::vector<float>
hullDistance (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& free_space, int threads)
{
  std::vector<std::uint8_t> hull (free_space.size ());
  std::transform (free_space.begin (), free_space.end (), hull.begin (), [] (std::uint8_t free) { return free == 0; });
  std::vector<float> distance = distanceTransform (dims, hull, threads);
  parallelFor (0, dims.z (), threads, [&] (int k) {
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
      {
        // The nearest voxel outside the volume is straight across the nearest border.
        const int border = std::min ({i + 1, j + 1, k + 1, dims.x () - i, dims.y () - j, dims.z () - k});
        float& d = distance[(static_cast<std::size_t> (k) * dims.y () + j) * dims.x () + i];
        d = std::min (d, static_cast<float> (border));
      }
  });
  return distance;
}

FreeSpaceCarving::FreeSpaceCarving (const VoxelGrid& grid, bool revise, int threads)
    : grid_ (grid)
    , revise_ (revise)
    , threads_ (threads)
    , bound_vox_ (grid.size ())
    , inside_vox_ (grid.size (), nothing)
    , at_band_ (grid.size (), 0)
    , votes_for_ (grid.size (), 0)
    , votes_against_ (grid.size (), 0)
{}

void
FreeSpaceCarving::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, int body)
{
  const PinholeCamera& camera = view.view ().camera;
  ++views_;
  const PixelRegion region = projectedRegion (grid_, camera, T_grid_sensor);
  const std::vector<float> opened = view.freeDepth (view.openedDepth (), body, grid_.voxel_size_m, 0.0f,
                                                    grown (region, window, camera));
  const std::vector<float> lowest = filterDepth (opened, camera, window, false, region);
  const std::vector<float> highest = filterDepth (opened, camera, window, true, region);
  const double focal = 0.5 * (camera.fx + camera.fy);
  const Bands bands (opened, camera, grown (region, window, camera));

  forEachProjectedVoxel (grid_, camera, T_grid_sensor, threads_, [&] (const ProjectedVoxel& voxel) {
    const auto reach = static_cast<float> (voxel.z);
    if (highest[voxel.pixel] <= reach)
      return; // nothing free near
    const double voxels_per_pixel = voxel.z / focal / grid_.voxel_size_m;
    const bool free_here = opened[voxel.pixel] > reach;
    OtherPixel other{voxel.pixel, window * window};
    if (!free_here || lowest[voxel.pixel] <= reach)
      other = nearestOther (opened, camera, voxel, free_here);
    const std::size_t n = voxel.index;
    double inset_vox = inset_px * voxels_per_pixel;
    const std::size_t not_free = free_here ? other.pixel : voxel.pixel;
    if (const double most_vox = bands.halfWidth (not_free, reach) * voxels_per_pixel - 0.5 * least_wall_vox;
        opened[not_free] <= reach && most_vox < inset_vox)
    {
      inset_vox = most_vox;
      at_band_[n] = 1;
    }
    const double distance_vox = std::sqrt (other.squared_px) * voxels_per_pixel;
    const auto signed_vox = static_cast<float> ((free_here ? distance_vox : -distance_vox) + inset_vox);
    if (signed_vox > -far_vox)
      bound_vox_[n].add (signed_vox);
    if (signed_vox > 0.0f)
      vote (votes_for_[n]);
    else
      inside_vox_[n] = std::max (inside_vox_[n], signed_vox);
    const float depth = view.view ().depth[voxel.pixel];
    if (!free_here && !view.showsOther (voxel.pixel, body) &&
        std::abs (depth - voxel.z) <= freeSpaceMargin (view.view (), voxel.z, grid_.voxel_size_m))
      vote (votes_against_[n]);
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

  // A binomial filter removes the staircase of the pixels. It would remove bands, too.
  std::vector<float> smooth (bounds.size ());
  parallelFor (0, grid_.dims.z (), threads_, [&] (int k) {
    for (int j = 0; j < grid_.dims.y (); ++j)
      for (int i = 0; i < grid_.dims.x (); ++i)
      {
        const std::size_t n = grid_.index (i, j, k);
        smooth[n] = bounds[n];
        if (std::abs (bounds[n]) >= far_vox || at_band_[n] || !grid_.contains (i - 1, j - 1, k - 1) ||
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
