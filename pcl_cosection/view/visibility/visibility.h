// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <cmath>
#include <optional>

namespace pcl::cosection {

/** \brief What a depth view says of a point. */
enum class PointVisibility
{
  Outside,   ///< it is not before the camera, or not in the image
  NoReading, ///< its pixel has no reading
  Occluded,  ///< the reading is nearer
  AtSurface, ///< the reading is as far as the point
  Free,      ///< the reading is farther: the view looks through the point
};

/** \brief The pixel, column and row, that shows a place in the sensor's frame, if any does. */
inline std::optional<Eigen::Array2i>
pixelOf (const PinholeCamera& camera, const Eigen::Vector3d& p)
{
  if (!(p.z () > 0.0))
    return std::nullopt;
  const Eigen::Vector2d pixel = camera.project (p) + Eigen::Vector2d::Constant (0.5);
  if (!(pixel.x () >= 0.0 && pixel.y () >= 0.0 && pixel.x () < camera.width && pixel.y () < camera.height))
    return std::nullopt;
  return pixel.cast<int> ().array ();
}

/** \brief Whether a depth is one that a sensor measured. */
inline bool
isReading (double depth_m)
{
  return depth_m > 0.0 && std::isfinite (depth_m);
}

/** \brief What a reading says of a point on its ray, both metres along the optical axis.
 * \param[in] margin_m how much they may differ at one surface: the sensor's noise and the size of what stands for the
 * point, as freeSpaceMargin () and pointMargin () have it */
inline PointVisibility
compareWithReading (double depth_m, double reading_m, double margin_m)
{
  if (!isReading (reading_m))
    return PointVisibility::NoReading;
  const double gap_m = reading_m - depth_m;
  return gap_m < -margin_m  ? PointVisibility::Occluded
         : gap_m > margin_m ? PointVisibility::Free
                            : PointVisibility::AtSurface;
}

/** \brief What the reading of a point's pixel says of it. \param[in] p in the sensor's frame, metres
 * \param[in] margin_m see compareWithReading ()
 *
 * Edges of surfaces are frayed by half a pixel, and readings beside them are wrong: who cuts space away by this asks
 * FreeSpaceView for the pixels around, too. */
inline PointVisibility
visibilityOf (const Eigen::Vector3d& p, const DepthView& view, double margin_m)
{
  const std::optional<Eigen::Array2i> pixel = pixelOf (view.camera, p);
  return pixel ? compareWithReading (p.z (), view.at (pixel->x (), pixel->y ()), margin_m) : PointVisibility::Outside;
}

} // namespace pcl::cosection
