// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/fusion/sequence_fusion.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The TSDF volume of an object, which is placed by the first points that are seen of it and grows with more. */
class ObjectTsdf
{
public:
  explicit ObjectTsdf (const ObjectTsdfOptions& options = {});

  /** \brief Make room for points, object frame; a hundredth of them at either end of each axis counts as outliers. What
   * was integrated stays, unless most of the points are beyond the largest volume: then a sliver of the object was seen
   * before, and a new volume with larger voxels begins. Fewer than 20 points make none. */
  void makeRoom (const std::vector<OrientedPoint>& points);

  /** \brief TsdfVolume::integrate (); nothing until there is room. */
  void integrate (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor,
                  const TsdfPixels& pixels);

  /** \brief Nothing until there is room. */
  const std::optional<TsdfVolume>& volume () const { return volume_; }

private:
  ObjectTsdfOptions options_;
  std::optional<TsdfVolume> volume_;
};

} // namespace pcl::cosection
