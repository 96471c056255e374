// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "object_depth_buffer.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief A block of voxels, at most size^3. */
struct VoxelTile
{
  static constexpr int size = 8;
  Eigen::Vector3i first; // voxel
  Eigen::Vector3i end;   // one beyond
};

/** \brief The tiles of a grid. */
std::vector<VoxelTile> tilesOf (const VoxelGrid& grid);

/** \brief The strongest of what views say of places that they do not see free, as views and points are added.
 *
 * More views and more points only hide more, so that what is known of a voxel remains: with a view more, only that view
 * is asked of all voxels; and earlier ones where the new points have changed how they see the object. The result is
 * that of all views and points at once. Everything is in the points' frame. */
class OcclusionMap
{
public:
  using Views = std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>;

  /** \brief Take in what is new; everything, if there are fewer views or points than at the last call or poses have
   * changed.
   * \param[in] views all of them, those of the last call first, and their sensors' poses; they must live until the next
   * call or the last use
   * \param[in] points all of them, those of the last call first */
  void add (const Views& views, const std::vector<OrientedPoint>& points, int threads = 0);

  /** \brief Forget views and points. */
  void clear ();

  /** \brief What hides a place. */
  Hidden at (const Eigen::Vector3d& p) const;

  /** \brief Is a place behind the surface of something else, and nothing of the object before it, in any view? */
  bool isBehindOther (const Eigen::Vector3d& p) const;

  /** \brief Begin asking for the voxels of a grid. */
  void begin (const VoxelGrid& grid);

  /** \brief Find out what hides the voxels of a tile; different tiles may be asked for by different threads.
   * \param[in] wanted of the tile's voxels, in their order, those that matter: the others' values have no meaning
   * \param[out] hidden one per voxel of the tile */
  void find (const VoxelTile& tile, const std::vector<std::uint8_t>& wanted, std::vector<Hidden>& hidden);

  /** \brief All tiles have been asked for. */
  void end ();

  std::size_t bytes () const;

private:
  Views views_;
  std::vector<ObjectDepthBuffer> depth_buffers_; // one per view
  std::size_t points_ = 0;                       // that were added
  VoxelGrid grid_;
  std::vector<std::uint8_t> known_; // per voxel what hides it, or stale and what hid it when it was last asked for
  std::size_t views_known_ = 0;     // that have been asked for the voxels which are not stale
};

} // namespace pcl::cosection
