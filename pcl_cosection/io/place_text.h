// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Core>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

namespace pcl::cosection {

/** \brief "(0.5, -1.25, 2)", to three digits or whole numbers; millionths are zero */
inline std::string
placeText (const Eigen::Vector3d& place)
{
  std::ostringstream text;
  const auto rounded = [] (double x) {
    constexpr double large = 1000.0; // of which three digits would say little
    std::ostringstream number;
    number << std::setprecision (std::abs (x) < large ? 3 : 15)
           << (std::abs (x) < 1e-6    ? 0.0
               : std::abs (x) < large ? x
                                      : std::round (x));
    return number.str ();
  };
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
