// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <optional>

namespace pcl::cosection
{

struct BackgroundOptions
{
  int resolution = 256;      ///< voxels along each axis
  double voxel_size_m = 0.0; ///< 0: so that the volume reaches as far as the first frame, up to 2 cm
  TsdfOptions tsdf;
};

/** \brief The TSDF volume of what does not move, in the world frame. It follows the camera: what is far behind is
 * forgotten. */
class BackgroundModel
{
public:
  explicit BackgroundModel (const BackgroundOptions& options) : options_ (options) {}

  /** \brief Place the volume around what the first frame shows, later shift it to what is in view. Nothing without
   * readings. */
  void follow (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  std::optional<TsdfVolume>& volume () { return volume_; }

  const std::optional<TsdfVolume>& volume () const { return volume_; }

  /** \brief How often the volume was shifted. */
  int shifts () const { return shifts_; }

private:
  BackgroundOptions options_;
  std::optional<TsdfVolume> volume_;
  int shifts_ = 0;
};

} // namespace pcl::cosection
