// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_depth_buffer.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief A block of voxels, at most size^3. */
struct VoxelTile
{
  static constexpr int size = 8;
  Eigen::Vector3i first; // voxel
  Eigen::Vector3i end;   // one beyond
};

/** \brief The tiles of a grid. */
std::vector<VoxelTile> tilesOf (const VoxelGrid& grid);

/** \brief What hides places that are not seen free, as the maximum of Hidden over all views. Views and points can be
 * added.
 *
 * Further views and points can only hide more, so the results of voxels are kept: a new view is evaluated at all
 * voxels, earlier ones only where new points changed their depth buffers. The result is that of all views and points at
 * once. Everything is in the points' frame. */
class OcclusionMap
{
public:
  using Views = std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>;

  /** \brief Add new views and points. Starts again if there are fewer of either than at the last call, or if poses have
   * changed.
   * \param[in] views all views, those of the last call first, and their sensors' poses; they must live until the next
   * call or the last use
   * \param[in] points all points, those of the last call first */
  void add (const Views& views, const std::vector<OrientedPoint>& points, int threads = 0);

  /** \brief Remove all views and points. */
  void clear ();

  /** \brief What hides a place. */
  Hidden at (const Eigen::Vector3d& p) const;

  /** \brief Whether in some view a place is behind the surface of something else, without the object in front of it. */
  bool isBehindOther (const Eigen::Vector3d& p) const;

  /** \brief Begin a query of the voxels of a grid. */
  void begin (const VoxelGrid& grid);

  /** \brief What hides the voxels of a tile. Different threads may query different tiles.
   * \param[in] wanted 1 for the voxels of the tile whose result is needed, in their order; others get any value
   * \param[out] hidden one value per voxel of the tile */
  void find (const VoxelTile& tile, const std::vector<std::uint8_t>& wanted, std::vector<Hidden>& hidden);

  /** \brief End the query; all tiles have been visited. */
  void end ();

  std::size_t bytes () const;

private:
  Views views_;
  std::vector<ObjectDepthBuffer> depth_buffers_; // one per view
  std::size_t points_ = 0;                       // number of points added
  VoxelGrid grid_;
  std::vector<std::uint8_t> known_; // per voxel the last result, with a mark if it is stale
  std::size_t views_known_ = 0;     // number of views in the results that are not stale
};

} // namespace pcl::cosection
