// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl::cosection {

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
  ObjectDepthBuffer (const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor);

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
  /** \brief The pixel of a place (sensor's frame); false if it is out of view. */
  bool find (const Eigen::Vector3d& p, int& u, int& v) const;
  /** \brief Enlarge the buffer to hold the cells from \a low to \a high. */
  void extend (const Eigen::Array2i& low, const Eigen::Array2i& high);

  float depthOf (int u, int v) const
  {
    const Eigen::Array2i at = Eigen::Array2i (u, v) / cell_px - first_;
    return (at < 0).any () || (at >= size_).any () ? std::numeric_limits<float>::infinity ()
                                                   : depth_[static_cast<std::size_t> (at.y ()) * size_.x () + at.x ()];
  }

  static constexpr int cell_px = 4;
  PinholeCamera camera_;
  Eigen::Isometry3d T_sensor_object_;
  Eigen::Array2i first_ = Eigen::Array2i::Zero (); // first cell of the buffer; cells beyond it show no point
  Eigen::Array2i size_ = Eigen::Array2i::Zero ();
  std::vector<float> depth_;
  std::vector<std::uint8_t> changed_;
  bool any_changed_ = false;
};

} // namespace pcl::cosection
