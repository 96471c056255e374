// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "visibility_check.h"

#include <pcl/cosection/tracking/surface_points.h>

#include <cmath>

namespace pcl::cosection
{

double
Visibility::inViewShare () const
{
  const std::size_t all = facing ();
  return all > 0 ? static_cast<double> (confirmed + contradicted) / static_cast<double> (all) : 0.0;
}

double
Visibility::confirmedShare () const
{
  const std::size_t seen = confirmed + contradicted;
  return seen > 0 ? static_cast<double> (confirmed) / static_cast<double> (seen) : 1.0;
}

Visibility
checkVisibility (const TsdfVolume& volume, const Eigen::Isometry3d& T_model_camera, const FrameCloud& cloud,
                 double tolerance_m)
{
  Visibility result;
  const Eigen::Isometry3d T_camera_model = T_model_camera.inverse ();
  const Eigen::Vector3f eye = T_model_camera.translation ().cast<float> ();
  for (const Eigen::Vector3f& point : surfacePoints (volume.field ()))
  {
    const auto cell = volume.sample<float> (point);
    if (!cell || cell->gradient ().dot (eye - point) <= 0.0f)
      continue; // it is turned away, or at the end of the known space
    const Eigen::Vector3d p = T_camera_model * point.cast<double> ();
    const Eigen::Vector2d pixel = p.z () > 0.0 ? cloud.camera.project (p) : Eigen::Vector2d (-1.0, -1.0);
    if (!(pixel.x () > -0.5 && pixel.y () > -0.5 && pixel.x () < cloud.camera.width - 0.5 &&
          pixel.y () < cloud.camera.height - 0.5))
    {
      ++result.outside;
      continue;
    }
    const float z = cloud.depth.at (static_cast<int> (std::lround (pixel.x ())),
                                    static_cast<int> (std::lround (pixel.y ())));
    const double tolerance = tolerance_m + 3.0 * depthNoiseSigma (p.z ());
    if (!std::isfinite (z))
      ++result.unread;
    else if (z < p.z () - tolerance)
      ++result.occluded;
    else if (z > p.z () + tolerance)
      ++result.contradicted;
    else
      ++result.confirmed;
  }
  return result;
}

} // namespace pcl::cosection
