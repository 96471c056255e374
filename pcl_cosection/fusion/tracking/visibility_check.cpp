// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "visibility_check.h"

#include "pcl_cosection/view/visibility.h"

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
  const std::size_t told = confirmed + contradicted;
  return told > 0 ? static_cast<double> (confirmed) / static_cast<double> (told) : 1.0;
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
      continue; // it is turned away, or at the end of what is known
    const Eigen::Vector3d p = T_camera_model * point.cast<double> ();
    const std::optional<Eigen::Array2i> pixel = pixelOf (cloud.camera, p);
    if (!pixel)
    {
      ++result.outside;
      continue;
    }
    switch (compareWithReading (p.z (), cloud.depth.at (pixel->x (), pixel->y ()),
                                tolerance_m + 3.0 * depthNoiseSigma (p.z ())))
    {
    case PointVisibility::Occluded:
      ++result.occluded;
      break;
    case PointVisibility::AtSurface:
      ++result.confirmed;
      break;
    case PointVisibility::Free:
      ++result.contradicted;
      break;
    default:
      ++result.unread;
    }
  }
  return result;
}

} // namespace pcl::cosection
