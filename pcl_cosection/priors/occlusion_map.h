// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

constexpr int outline_cell_px = 4; ///< of an object's outline in a sensor's image: closes the gaps between readings

/** \brief What hides a place from a view that does not see it free. */
enum class Hidden : std::uint8_t
{
  Nothing,  ///< no reading in front of it, or out of view
  ByOther,  ///< the surface of something else
  ByObject, ///< an observed surface of the object
};

/** \brief Depth buffer of an object's points in one view: the nearest depth per cell of the image. Cells of several
 * pixels close the gaps between points. Further points can only hide more places. */
class ObjectDepthBuffer
{
public:
  /** \param[in] T_object_sensor pose of the sensor in the points' frame */
  ObjectDepthBuffer (const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor)
      : camera_ (camera)
      , T_sensor_object_ (T_object_sensor.inverse ())
  {}

  /** \brief Add points from the \a first on; cells that this makes nearer count as changed. */
  void add (const std::vector<OrientedPoint>& points, std::size_t first = 0);

  /** \brief Mark all cells as unchanged. */
  void settle ();

  bool changed () const { return any_changed_; }

  /** \brief What hides \a p. \param[in] view the depth image */
  Hidden at (const Eigen::Vector3d& p, const DepthView& view) const;

  /** \brief Visibility of a box of places. */
  struct Outlook
  {
    bool in_view = false;          ///< some places may be in view
    bool all_hidden = false;       ///< the object hides all places
    bool may_be_hidden = false;    ///< the object may hide some places
    bool may_have_changed = false; ///< the cells of some places may have changed
  };

  /** \param[in] center of the box \param[in] half_sizes of the box, along the axes of the points' frame */
  Outlook outlook (const Eigen::Vector3d& center, const Eigen::Vector3d& half_sizes) const;

  std::size_t bytes () const { return depth_.capacity () * sizeof (float) + changed_.capacity (); }

private:
  /** \brief Enlarge the buffer to hold the cells from \a low to \a high. */
  void extend (const Eigen::Array2i& low, const Eigen::Array2i& high);

  std::size_t indexOf (int column, int row) const { return static_cast<std::size_t> (row) * size_.x () + column; }

  PinholeCamera camera_;
  Eigen::Isometry3d T_sensor_object_;
  Eigen::Array2i first_ = Eigen::Array2i::Zero (); // first cell of the buffer; cells beyond it show no point
  Eigen::Array2i size_ = Eigen::Array2i::Zero ();
  std::vector<float> depth_;
  std::vector<std::uint8_t> changed_;
  bool any_changed_ = false;
};

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
  using Views = SensorViews;

  /** \brief Add new views and points. Starts again if there are fewer of either than at the last call, or if poses have
   * changed.
   * \param[in] views all views, those of the last call first, and their sensors' poses; they must live until the next
   * call or the last use
   * \param[in] points all points, those of the last call first */
  void add (const Views& views, const std::vector<OrientedPoint>& points, int threads = 0);

  /** \brief Remove all views and points. */
  void clear () { *this = OcclusionMap (); }

  /** \brief What hides a place. */
  Hidden at (const Eigen::Vector3d& p) const;

  /** \brief Whether in some view a place is behind the surface of something else, without the object in front of it. */
  bool isBehindOther (const Eigen::Vector3d& p) const;

  /** \brief Begin a query of the voxels of a grid. */
  void begin (const VoxelGrid& grid);

  /** \brief What hides the voxels of a tile. Different threads may query different tiles.
   * \param[in] wanted 1 for the voxels of the tile whose result is needed, in their order; others get any value
   * \return one value per voxel of the tile */
  std::vector<Hidden> find (const VoxelTile& tile, const std::vector<std::uint8_t>& wanted);

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
