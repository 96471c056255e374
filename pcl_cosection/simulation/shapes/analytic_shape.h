// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <cmath>
#include <string>

namespace pcl::cosection {

/** \brief A shape whose distance is a formula. */
class AnalyticShape : public Shape
{
public:
  bool isAnalytic () const override { return true; }
};

/** \return value \throws InvalidArgument naming it, if it is no length */
inline double
positive (double value, const char* name)
{
  if (!(std::isfinite (value) && value > 0.0))
    throw InvalidArgument (std::string (name) + " must be a positive number");
  return value;
}

} // namespace pcl::cosection
