// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <sstream>
#include <string>

namespace pcl
{
namespace cosection
{

/** \brief "(0.5, -1.25, 2)" */
inline std::string
placeText (const Eigen::Vector3d& place)
{
  std::ostringstream text;
  text.precision (3);
  text << '(' << place.x () << ", " << place.y () << ", " << place.z () << ')';
  return text.str ();
}

} // namespace cosection
} // namespace pcl
