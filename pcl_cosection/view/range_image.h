// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief An unorganised cloud as it looks from where its sensor stood. */
struct RangeImage
{
  /** \brief Of the points that a sensor saw; more says that it stood elsewhere. */
  static constexpr double max_hidden_share = 0.1;
  static constexpr std::size_t min_points = 50; ///< that are worth a picture

  DepthView view; ///< nearest point of each pixel; the optical axis passes through the middle of the points, or is
                  ///< their mean direction
  std::vector<DepthView> others; ///< further ones from the same place, of what spans too much for one
  double hidden_share = 0.0;     ///< of the points, clearly behind others: large if the sensor cannot have stood there

  /** \brief Whether a point, in the frame of the view's pose, lies clearly behind what the view shows in its pixel. */
  bool hides (const Eigen::Vector3f& point) const;

  /** \brief Of the objects, the largest share of what one covers that shows something clearly behind it, as no sensor
   * sees: pixels in which a point of it is the nearest, without those of its border. O (points + pixels).
   * \param[in] points in the frame of the view's pose; not finite: left out
   * \param[in] labels of the points; 0: of no object
   * \return 0 if no object covers 50 pixels */
  double seenThrough (const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& labels) const;
};

/** \brief Draw an unorganised cloud as a depth image, so that the space in front of its points counts as seen free.
 *
 * The pixels are as large as the spacing of the points asks for: a few points fall into each pixel that has any.
 * Pixels without a point have no reading. O (points).
 * \param[in] points metres; not finite: left out
 * \param[in] sensor where the sensor stood, in the points' frame, which is also the frame of the view's pose
 * \return nothing for fewer than 50 points, or if some are more than 60 degrees from both the middle of their box and
 * their mean direction as seen from the sensor */
std::optional<RangeImage> drawRangeImage (const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor);

/** \brief The view with pixels without a reading around it, half of its longer side wide: rays that passed its points.
 */
DepthView withSurroundings (const DepthView& view);

/** \brief Draw points that a sensor saw all around, as a spinning lidar, as drawRangeImage () does: a depth image for
 * each face of a cube about it that has points, the one with the most first. */
std::optional<RangeImage> drawPanorama (const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor);

/** \brief Where the points of an object may have been seen from, if nothing is known of that: the direction to which
 * nearly all of them face, from far away. To judge how far hidden parts may reach, not to call space free.
 * \return nothing if there is no such direction, as for points from all around */
std::optional<DepthView> virtualViewpoint (const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
