// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/visibility/free_space_view.h"
#include <pcl/cosection/volume/signed_distance_field.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Votes of depth views on what is free: the complement of the hull of equation (3).
 *
 * A voxel is free in a view when the depth along its ray exceeds its own by more than the margin,
 * max (3 voxels, 3 sigma_z), for every reading in its footprint. Missing readings and pixels at depth
 * edges say nothing, and what lies outside the volume counts as hull. A voxel at a seen surface (within
 * the margin) is a vote against; so a few wrong pixels or a slightly wrong pose can be outvoted. */
class HullConstraint
{
public:
  explicit HullConstraint (const VoxelGrid& grid, int threads = 0) : HullConstraint (grid, grid, threads) {}

  /** \param[in] whole the volume of which \a grid is a part: voxels get the votes that they get there */
  HullConstraint (const VoxelGrid& grid, const VoxelGrid& whole, int threads);

  /** \brief Add the votes of one view. \param[in] T_grid_sensor pose of the sensor in the grid's frame
   * \param[in] body whose volume it is, as the view numbers them */
  void add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, int body = FreeSpaceView::unknown_body);

  /** \brief 1 where free.
   * \param[in] revise free means more votes for than against; else one vote suffices for ever (paper) */
  std::vector<std::uint8_t> freeSpace (bool revise) const;

private:
  VoxelGrid grid_;
  VoxelGrid whole_;
  int threads_;
  std::vector<std::uint8_t> votes_for_;
  std::vector<std::uint8_t> votes_against_;
};

/** \brief d_hull of equation (3): exact Euclidean distance, in voxels, from free voxels to the hull (to
 * the nearest voxel that is not free; all voxels outside the volume are not); 0 elsewhere. */
std::vector<float> hullDistance (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& free_space,
                                 int threads = 0);

/** \brief Signed distance to the boundary of the space that views saw free, finer than a voxel, for cutting
 * a shape along its silhouettes: the quadratic penalty of the hull constraint leaves a rim of about a
 * voxel outside, and hidden walls run along the rays, where such a rim is wide.
 *
 * Per view the distance is measured in the image, from a voxel's projection to the nearest pixel that is
 * free at the voxel's depth (or, from within free space, to the nearest that is not), up to a few pixels.
 * Readings count as for HullConstraint, but free patches of less than 3 x 3 pixels are ignored. A voxel is
 * cut only where more views see it free than see a surface there. As poses and silhouettes are not exact, a cut that
 * only one of several views supports is made farther out than one that several support. What an image shows as a band
 * of less than five pixels keeps the least width of a wall. */
class FreeSpaceCarving
{
public:
  /** \param[in] revise false: one view that sees a voxel free suffices */
  FreeSpaceCarving (const VoxelGrid& grid, bool revise, int threads = 0);

  /** \param[in] body see HullConstraint::add () */
  void add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, int body = FreeSpaceView::unknown_body);

  /** \brief Distances in voxels within [-3, 3], positive in free space: near the boundary, lower bounds of a
   * field that keeps out of it.
   * \param[in] offset_any apply the offset of weakly supported cuts also if there is one view only, so that no bound
   * decreases when a view is added */
  std::vector<float> lowerBounds (bool offset_any = false) const;

private:
  static constexpr float nothing = -1e6f;
  static constexpr int full_support = 4; // views

  /** \brief A robust maximum over views, as the maximum of many noisy values would be too large: the largest value
   * less an offset that shrinks with the number of views that support it. It never decreases with another view. */
  struct Supported
  {
    std::array<float, full_support> largest{nothing, nothing, nothing, nothing};

    void add (float value)
    {
      for (float& kept : largest)
        if (value > kept)
          std::swap (value, kept);
    }

    float value (float offset_vox) const
    {
      float best = nothing;
      for (int n = 1; n <= full_support; ++n) // views
        best = std::max (best,
                         largest[n - 1] - offset_vox * static_cast<float> (full_support - n) / (full_support - 1));
      return best;
    }
  };

  VoxelGrid grid_;
  int views_ = 0;
  bool revise_;
  int threads_;
  std::vector<Supported> bound_vox_;  // distance to what a view sees free
  std::vector<float> inside_vox_;     // largest (nearest to 0) distance of a view that sees the voxel not free
  std::vector<std::uint8_t> at_band_; // 1 where the bound is that of a band
  std::vector<std::uint8_t> votes_for_;
  std::vector<std::uint8_t> votes_against_;
};

} // namespace pcl::cosection
