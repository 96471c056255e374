// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>

#include <sstream>

namespace pcl::cosection {

void
DecimationOptions::validate () const
{
  const auto require = [] (bool ok, const char* name, double value, const char* domain) {
    if (ok)
      return;
    std::ostringstream message;
    message << "decimate: " << name << " is " << value << "; it must be " << domain;
    throw InvalidArgument (message.str ());
  };
  require (max_triangles >= 1, "largest number of triangles", static_cast<double> (max_triangles), "at least 1");
  require (max_normal_turn_deg > 0.0 && max_normal_turn_deg <= 90.0, "largest turn of a normal", max_normal_turn_deg,
           "positive and at most 90 degrees");
  require (min_quality >= 0.0 && min_quality <= 1.0, "least quality of a triangle", min_quality, "between 0 and 1");
  require (boundary_weight >= 0.0 && boundary_weight <= 1e6, "weight of the boundary", boundary_weight,
           "between 0 and 1e6");
}

} // namespace pcl::cosection
