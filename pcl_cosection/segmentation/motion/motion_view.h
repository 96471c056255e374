// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/segmentation/geometry/depth_grid.h"

#include <pcl/cosection/segmentation/motion_segmentation.h>

#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief A frame, reduced, as others are compared with it. */
struct MotionView
{
  PinholeCamera camera;
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals; ///< NaN: none
  std::vector<char> room;               ///< whether it lies on a plane of the room; empty: not analysed yet, as normals
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity ();
  std::vector<std::uint32_t> bodies; ///< known ones, 0: none
  std::vector<std::uint32_t> found;  ///< all that were found; empty: this was not asked for
  std::map<std::uint32_t, Eigen::Isometry3d> T_world_body;

  DepthGrid grid () const
  {
    return {points, normals, camera.width, camera.height, static_cast<float> (1.0 / camera.fx)};
  }

  bool hasNormal (int i) const { return std::isfinite (normals[i].x ()); }
};

/** \brief A frame's pixels so reduced, not analysed. */
MotionView makeMotionView (const MotionFrame& frame);

/** \brief Find normals and planes, if that is not done. */
void analyse (MotionView& view, const MotionSegmentationOptions& options);

/** \brief What a view says of a place. */
struct Sighting
{
  int pixel = -1;       ///< the one around whose reading is nearest; -1: nothing is known of the place
  float ahead_m = 0.0f; ///< how much farther than the place that reading is: positive, where it was seen through
};

/** \brief The reading nearest to the place, among those beside its pixel, which differ by edges and grazing surfaces.
 * \param[in] q sensor frame of the view */
Sighting sightAt (const MotionView& view, const Eigen::Vector3f& q);

/** \brief One per pixel of a view: what another one says of its reading. \param[in] T_other_view of what the view shows
 */
std::vector<Sighting> compareViews (const MotionView& view, const MotionView& other,
                                    const Eigen::Isometry3d& T_other_view, int threads);

/** \brief Standard deviation of the difference of two readings of one place. */
inline float
differenceSigma (float z)
{
  return 1.41421f * static_cast<float> (depthNoiseSigma (z));
}

/** \brief By how much the noise of two views at rest, and the error of their poses, exceeds what is expected: at
 * least 1. */
float noiseScale (const MotionView& view, const std::vector<Sighting>& sightings);

/** \brief Labels of a reduced view for all pixels of its frame: that of the reading beside which is nearest in depth.
 */
std::vector<std::uint32_t> enlarged (const std::vector<std::uint32_t>& labels, const MotionView& view,
                                     const MotionFrame& frame);

} // namespace pcl::cosection
