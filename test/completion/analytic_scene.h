// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "volume/analytic_fields.h"

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection::test {

/** \brief A camera of few pixels, for tests of single views. */
inline PinholeCamera
smallCamera ()
{
  return {160, 120, 140.0, 140.0, 79.5, 59.5};
}

/** \brief A shape put somewhere. */
Distance placed (const Distance& shape, const Eigen::Isometry3d& T_world_shape);
Distance placed (const Distance& shape, const Eigen::Vector3d& position);

/** \brief A cup that stands on z = 0, open at the top. */
Distance cup (double outer_radius, double height, double wall);

/** \brief The half-space n.x + d < 0; unit n. */
Distance halfSpace (const Eigen::Vector4d& plane);

/** \brief Direction of steepest ascent of a distance, by central differences. */
Eigen::Vector3d gradient (const Distance& distance, const Eigen::Vector3d& p);

/** \brief A depth view with its labels and points. */
struct RenderedView
{
  DepthView view;
  std::vector<int> labels;                          ///< per pixel; -1 where nothing was hit
  std::map<int, std::vector<OrientedPoint>> points; ///< of each label, world frame
};

/** \brief Bodies of known shape, by label; 0 is the background. */
class AnalyticScene
{
public:
  void add (int label, Distance shape);

  const Distance& shape (int label) const { return shapes_.at (label); }

  /** \brief Depth without noise by sphere tracing, up to \a max_range_m. */
  RenderedView render (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_sensor,
                       double max_range_m = 3.0) const;

  /** \brief This scene moved by \a T. */
  AnalyticScene moved (const Eigen::Isometry3d& T) const;

private:
  std::map<int, Distance> shapes_;
};

} // namespace pcl::cosection::test
