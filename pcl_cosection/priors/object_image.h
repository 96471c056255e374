// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief What one view shows of a place near an object. */
enum class Shown : std::uint8_t
{
  Nothing,     ///< no reading, or out of view
  Free,        ///< the view looks through the place
  Object,      ///< the object's surface is there
  Turned,      ///< the object's surface is there, with another normal
  BehindOwn,   ///< the object is nearer
  BehindOther, ///< something else is nearer
};

/** \brief One view, with the object's points by pixel. Readings at the edges of surfaces, which were left out but are
 * as near, are the object's, too. */
class ObjectImage
{
public:
  /** \param[in] T_object_sensor pose of the sensor in the points' frame \param[in] points live as long as this */
  ObjectImage (const DepthView& view, const Eigen::Isometry3d& T_object_sensor,
               const std::vector<OrientedPoint>& points, double voxel_size_m);

  Shown at (const OrientedPoint& point) const;

  /** \brief Whether a place is behind something that is nearer than a point of the object, too. */
  bool isBehindNearer (const OrientedPoint& place, const OrientedPoint& point) const;

  /** \brief Share of the object's outline beside which something else is nearer; nothing without an outline. There may
   * be no readings between, no farther than the object is large in the image: beside what is near, some sensors have a
   * shadow.
   * \param[in] is_cut_out what is around the object was removed: only what is next to it hides it
   * \param[in] hides_nothing whether a reading, a place in the points' frame, does not count */
  std::optional<double> hiddenOutline (bool is_cut_out,
                                       const std::function<bool (const Eigen::Vector3d&)>& hides_nothing) const;

private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max ();

  std::size_t indexOf (const Eigen::Array2i& pixel) const
  {
    return static_cast<std::size_t> (pixel.y ()) * view_.camera.width + pixel.x ();
  }

  double marginOf (double depth_m) const;

  void growIntoEdges ();

  /** \brief The first pixel with a reading from one of the object on, in so many steps. */
  std::optional<Eigen::Array2i> firstReading (const Eigen::Array2i& pixel, const Eigen::Array2i& step, int steps) const;

  const DepthView& view_;
  Eigen::Isometry3d T_sensor_object_;
  const std::vector<OrientedPoint>& points_;
  double voxel_size_m_;
  std::vector<std::uint32_t> point_of_; // by pixel
};

} // namespace pcl::cosection
