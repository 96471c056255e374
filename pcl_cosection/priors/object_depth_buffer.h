// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl::cosection
{

/** \brief What hides a place from a view that does not see it free. */
enum class Hidden : std::uint8_t
{
  Nothing,  ///< no reading before it, or out of view
  ByOther,  ///< the surface of something else
  ByObject, ///< an observed surface of the object
};

/** \brief What a view sees of an object: the nearest depth of its points per cell of the image. Cells of some pixels
 * close the pores between points. The more points, the more is hidden. */
class ObjectDepthBuffer
{
public:
  /** \param[in] T_object_sensor pose of the sensor in the points' frame */
  ObjectDepthBuffer (const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor);

  /** \brief Add points from the \a first on; cells that this makes nearer count as changed. */
  void add (const std::vector<OrientedPoint>& points, std::size_t first = 0);

  /** \brief From now on no cell counts as changed. */
  void settle ();

  bool changed () const { return any_changed_; }

  /** \brief What hides \a p. \param[in] view the depth image */
  Hidden at (const Eigen::Vector3d& p, const DepthView& view) const;

  /** \brief What is known of all places in a box. */
  struct Outlook
  {
    bool in_view = false;       ///< some may be
    bool all_hidden = false;    ///< all are hidden by the object
    bool may_be_hidden = false; ///< by the object
    bool may_have_changed = false;
  };

  /** \param[in] center of the box \param[in] half_sizes of the box, along the axes of the points' frame */
  Outlook outlook (const Eigen::Vector3d& center, const Eigen::Vector3d& half_sizes) const;

  std::size_t bytes () const { return depth_.capacity () * sizeof (float) + changed_.capacity (); }

private:
  /** \brief The pixel that shows a place in the sensor's frame, if any does. */
  bool find (const Eigen::Vector3d& p, int& u, int& v) const;
  /** \brief Hold also the cells from \a low to \a high. */
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
  Eigen::Array2i first_ = Eigen::Array2i::Zero (); // cells that are held: others show no point
  Eigen::Array2i size_ = Eigen::Array2i::Zero ();
  std::vector<float> depth_;
  std::vector<std::uint8_t> changed_;
  bool any_changed_ = false;
};

} // namespace pcl::cosection
