// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <vector>

namespace pcl::cosection {

/** \brief How raycast () looks at volumes. */
struct PCL_COSECTION_EXPORT RaycastOptions
{
  int stride = 1;                                                ///< between pixels along rows and columns
  bool normals = false;                                          ///< beside depths
  bool weights = false;                                          ///< beside depths
  double max_depth_m = std::numeric_limits<double>::infinity (); ///< surfaces beyond are not seen
  int threads = 0;                                               ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument if \a stride or the depth is not positive, or \a threads is
   * negative. */
  void validate () const;
};

/** \brief A volume as a part of a scene. */
struct PCL_COSECTION_EXPORT RaycastBody
{
  const TsdfVolume* volume = nullptr; ///< must be set, and live as long as this is used
  /** \brief The sensor's pose in the frame of the volume's grid, metres. */
  Eigen::Isometry3d T_grid_sensor = Eigen::Isometry3d::Identity ();
  std::uint16_t id = 0;         ///< by custom, 0 is the background
  bool foreground_only = false; ///< rays pass surfaces whose foreground probability is not known to be above 1/2
};

/** \brief What a camera would see of volumes. */
struct PCL_COSECTION_EXPORT RaycastImage
{
  static constexpr std::uint16_t nothing = 0xffff; ///< no body's id

  PinholeCamera camera;     ///< of the images: with a stride, it is smaller than that asked for, with the same rays
  Image<float> depth;       ///< metres along the optical axis; NaN: nothing
  Image<std::uint16_t> ids; ///< of the body that is seen
  Image<Eigen::Vector3f> normals; ///< unit, sensor frame, out of the body; zero: nothing; empty unless asked for
  Image<float> weights;           ///< of the voxel nearest to the surface; 0: nothing; empty unless asked for
};

/** \brief Cast a ray through each pixel: where it first passes from positive distances to others, there is a surface;
 * the nearest of all bodies is seen, of equal ones the first in the list.
 *
 * R. Newcombe et al., "KinectFusion: Real-Time Dense Surface Mapping and Tracking", ISMAR 2011, Section 3.4; as there,
 * a ray that passes from known negative distances to positive ones has come through the back of something and ends
 * without having seen anything. Distances are interpolated between eight voxels that all have a weight: the surface is
 * that of TsdfVolume::surfaceMesh (). Where one has none, nothing is known: the ray goes on, and there is no surface
 * between what is known before and behind. Nor is there one where less than a step is known before or behind it, at the
 * rim of what is known.
 *
 * Steps are about one voxel, where distances of both signs are near; elsewhere blocks of voxels are passed at once. The
 * truncated distances themselves do not say how far a ray may go: they are those along the rays of other views, and
 * beside a thin body they are as large as far from it.
 *
 * O (voxels) to find out where signs differ, O (pixels of the surfaces' boxes * voxels along a ray at most) to cast.
 *
 * \code
 * const RaycastImage seen = raycast ({{&room, T_room_sensor, 0}, {&cup, T_cup_sensor, 1, true}}, camera);
 * \endcode
 * \throws InvalidArgument if the camera or an option is not valid, a body has no volume, its id is that of nothing, its
 * pose is not a finite rigid motion, or its foreground is asked for and was not counted */
PCL_COSECTION_EXPORT RaycastImage raycast (const std::vector<RaycastBody>& bodies, const PinholeCamera& camera,
                                           const RaycastOptions& options = {});

/** \brief What a camera would see of one volume, whose id is 0.
 * \throws InvalidArgument as for many */
PCL_COSECTION_EXPORT RaycastImage raycast (const TsdfVolume& volume, const PinholeCamera& camera,
                                           const Eigen::Isometry3d& T_grid_sensor, const RaycastOptions& options = {});

} // namespace pcl::cosection
