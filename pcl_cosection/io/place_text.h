// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Core>

#include <cmath>
#include <sstream>
#include <string>

namespace pcl::cosection {

/** \brief "(0.5, -1.25, 2)"; micrometres are zero */
inline std::string
placeText (const Eigen::Vector3d& place)
{
  std::ostringstream text;
  text.precision (3);
  const auto rounded = [] (double x) { return std::abs (x) < 1e-6 ? 0.0 : x; };
  text << '(' << rounded (place.x ()) << ", " << rounded (place.y ()) << ", " << rounded (place.z ()) << ')';
  return text.str ();
}

/** \brief What determines where the sensor stood. */
inline std::string
sourceOfViewpoint (const PcdViewOptions& options)
{
  return options.viewpoint ? "--viewpoint" : "its VIEWPOINT";
}

} // namespace pcl::cosection
