// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "imls_data_term.h"
#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The measurements of one body on its grid: sums over points and votes of views, to which more can be added at
 * any time. Everything is in the grid's frame. */
class ShapeEvidence
{
public:
  /** \param[in] carve also gather FreeSpaceCarving */
  ShapeEvidence (const VoxelGrid& grid, const CoSectionOptions& options, bool carve);

  /** \brief Evidence on a part of a volume, as on the whole of it; without carving, and without points until some are
   * added. */
  ShapeEvidence (const VoxelGrid& grid, const VoxelGrid& whole, const CoSectionOptions& options);

  void addPoints (const std::vector<OrientedPoint>& points)
  {
    data_.add (grid_, points, options_.sigma_vox, options_.threads);
  }

  void clearPoints ();

  /** \brief As clearPoints (), and free their memory until points are added. */
  void forgetPoints () { data_ = {}; }

  /** \param[in] silhouettes false: only votes on voxels, without carving, in a third of the time
   * \param[in] body whose measurements they are, as the view numbers them */
  void addView (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, bool silhouettes, int body);

  bool carves () const { return carving_.has_value (); }

  const VoxelGrid& grid () const { return grid_; }

  const CoSectionOptions& options () const { return options_; }

  /** \brief Sums over the points, not yet averaged. */
  const ImlsDataTerm& data () const { return data_; }

  /** \brief 1 where seen free. */
  std::vector<std::uint8_t> freeSpace () const { return hull_.freeSpace (options_.revise_votes); }

  /** \brief Lower bounds of FreeSpaceCarving in voxels; empty if it was not gathered. */
  std::vector<float> carvedBounds () const { return seen_ ? carving_->lowerBounds () : std::vector<float> (); }

private:
  VoxelGrid grid_;
  CoSectionOptions options_;
  ImlsDataTerm data_;
  HullConstraint hull_;
  std::optional<FreeSpaceCarving> carving_;
  bool seen_ = false; // whether carving_ has a view
};

/** \brief Directions of the normals of measured points, in six bins per voxel. Both sides of a thin wall are near the
 * points of either side; the normals show which of them was seen. */
class NormalBinOccupancy
{
public:
  NormalBinOccupancy () = default;
  NormalBinOccupancy (const VoxelGrid& grid, const std::vector<OrientedPoint>& points);

  /** \brief Whether no points were given. */
  bool empty () const { return ways_.empty (); }

  /** \brief Whether a point within three voxels has about the same normal as \a normal. */
  bool face (const Eigen::Vector3f& position, const Eigen::Vector3f& normal) const;

private:
  VoxelGrid grid_;
  std::vector<std::uint8_t> ways_; // by voxel, a bit for each sense of each axis
};

} // namespace pcl::cosection
