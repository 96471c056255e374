// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_priors.h"
#include "pcl_cosection/priors/symmetry/measured_shape.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The side of an object that its points show, as a slab along their plane. */
struct SeenSide
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero (); ///< unit, towards the sensor; zero: no points
  double low_m = 0.0, high_m = 0.0;                  ///< n.x of the points, without outliers
  double width_m = 0.0;                              ///< least extent along the plane, likewise

  /** \brief Whether the points fill hardly any of a depth along the normal. */
  bool isFlat (double depth_m) const;
};

SeenSide seenSide (const std::vector<OrientedPoint>& points);

/** \brief The plane that ends an object of which only a flat, steep side was seen: as far behind that side as the
 * extent prior lets it reach, if nothing was seen free in between.
 * \param[in] plane on which it stands
 * \return unit normal of the side, and offset; nothing if more was seen of the object */
std::optional<Eigen::Vector4d> planeBehindOnlySide (const Observation& object, const Eigen::Vector4d& plane,
                                                    const MeasuredShape& shape);

} // namespace pcl::cosection
