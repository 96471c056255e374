// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief What is taken from the frames of a sequence. */
struct PCL_COSECTION_EXPORT KeyframeOptions
{
  double max_depth_m = 10.0; ///< readings beyond are left out
  int background_step = 2;   ///< stride along rows and columns between the background's pixels that are used
  int threads = 0;           ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief The readings of one frame as oriented points, sorted by what they belong to. */
struct PCL_COSECTION_EXPORT Keyframe
{
  double stamp = 0.0;                               ///< of the frame
  DepthView view;                                   ///< of the whole scene, with the camera's pose
  std::map<int, std::vector<OrientedPoint>> points; ///< by instance, 0 the background; sensor frame
};

/** \brief The depth of a frame as a view of the scene, without readings beyond the largest depth. */
PCL_COSECTION_EXPORT DepthView makeDepthView (const Image<float>& depth, const PinholeCamera& camera,
                                              const Eigen::Isometry3d& T_world_camera,
                                              const KeyframeOptions& options = {});

/** \brief Turn a frame into a keyframe. Points without a reliable normal (computeOrganizedNormals ()) are left out.
 * \param[in] frame depth, and colour if there is any
 * \param[in] camera of the frame
 * \param[in] instances one per pixel, 0: background; empty: all is background
 * \param[in] T_world_camera pose of the camera, metres
 * \param[in] options what is taken
 * \throws InvalidArgument if \a instances or the depth have another size than the camera */
PCL_COSECTION_EXPORT Keyframe makeKeyframe (const RgbdFrame& frame, const PinholeCamera& camera,
                                            const Image<std::uint16_t>& instances,
                                            const Eigen::Isometry3d& T_world_camera,
                                            const KeyframeOptions& options = {});

} // namespace pcl::cosection
