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
 * pixels close the gaps between points. */
class ObjectDepthBuffer
{
public:
  /** \param[in] view the depth image
   * \param[in] T_object_sensor pose of the sensor in the points' frame */
  ObjectDepthBuffer (const DepthView& view, const Eigen::Isometry3d& T_object_sensor,
                     const std::vector<OrientedPoint>& points);

  /** \brief What hides \a p in the view. */
  Hidden at (const Eigen::Vector3d& p) const;

  /** \brief Visibility of a box of places. */
  struct Outlook
  {
    bool in_view = false;       ///< some places may be in view
    bool all_hidden = false;    ///< the object hides all places
    bool may_be_hidden = false; ///< the object may hide some places
  };

  /** \param[in] center of the box \param[in] half_sizes of the box, along the axes of the points' frame */
  Outlook outlook (const Eigen::Vector3d& center, const Eigen::Vector3d& half_sizes) const;

  std::size_t bytes () const { return sizeof (ObjectDepthBuffer) + depth_.capacity () * sizeof (float); }

private:
  std::size_t indexOf (const Eigen::Array2i& cell) const
  {
    return static_cast<std::size_t> (cell.y ()) * size_.x () + cell.x ();
  }

  const DepthView* view_;
  Eigen::Isometry3d T_sensor_object_;
  Eigen::Array2i first_ = Eigen::Array2i::Zero (); // first cell of the buffer; cells beyond it show no point
  Eigen::Array2i size_ = Eigen::Array2i::Zero ();
  std::vector<float> depth_;
};

/** \brief What hides places that are not seen free, as the maximum of Hidden over all views. Everything is in the
 * points' frame. */
class OcclusionMap
{
public:
  using Views = SensorViews;

  OcclusionMap () = default;

  /** \param[in] views with their sensors' poses; they must live as long as the map is used */
  OcclusionMap (const Views& views, const std::vector<OrientedPoint>& points, int threads = 0);

  /** \brief What hides a place; the object, if there are no views. */
  Hidden at (const Eigen::Vector3d& p) const;

  /** \brief What hides the voxels of a grid.
   * \param[in] wanted 1 for the voxels whose result is needed; others get any value */
  std::vector<Hidden> ofVoxels (const VoxelGrid& grid, const std::vector<std::uint8_t>& wanted, int threads) const;

  /** \brief Whether in some view a place is behind the surface of something else, without the object in front of it. */
  bool isBehindOther (const Eigen::Vector3d& p) const;

  std::size_t bytes () const;

private:
  std::vector<ObjectDepthBuffer> depth_buffers_; // one per view
};

} // namespace pcl::cosection
