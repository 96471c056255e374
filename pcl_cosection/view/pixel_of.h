// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <optional>

namespace pcl::cosection
{

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

} // namespace pcl::cosection
