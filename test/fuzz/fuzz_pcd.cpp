// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a PCD file: its header and its points in every encoding.

#include "fuzz_target.h"
#include "memory_file.h"
#include "pcd_seeds.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

void
check (const LabelledView& view)
{
  fuzz::require (!view.objects.empty (), "a view has points");
  for (const auto& [label, object] : view.objects)
  {
    fuzz::require (object.readings >= object.points.size (), "a point is a reading");
    for (const OrientedPoint& point : object.points)
    {
      fuzz::require (point.position.allFinite (), "positions are finite");
      fuzz::require (std::abs (point.normal.norm () - 1.0f) < 1e-3f, "normals have unit length");
    }
  }
  if (view.view)
  {
    view.view->camera.validate ();
    fuzz::require (view.view->T_world_sensor.matrix ().allFinite (), "the pose of the sensor is finite");
    fuzz::require (view.view->depth.size () == std::size_t (view.view->camera.width) * view.view->camera.height,
                   "a depth for every pixel");
    for (const float depth : view.view->depth)
      fuzz::require (std::isnan (depth) || (depth > 0.0f && std::isfinite (depth)), "depths are positive or missing");
  }
  for (const std::string& warning : view.warnings)
    fuzz::requireMessage (warning);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return (pcdSeeds ());
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"VERSION",  "FIELDS",    "COLUMNS",  "SIZE",      "TYPE",      "COUNT",  "WIDTH",
          "HEIGHT",   "VIEWPOINT", "POINTS",   "DATA",      "ascii",     "binary", "binary_compressed",
          "x",        "y",         "z",        "rgb",       "rgba",      "label",  "_",
          "normal_x", "normal_y",  "normal_z", "intensity", "curvature", "F",      "U",
          "I",        "1",         "2",        "4",         "8",         "#",      "# .PCD v0.7",
          "\n"};
}

bool
fuzz::accepts (const std::string& input)
{
  static MemoryFile file;
  file.set (input);
  PcdViewOptions options;
  options.threads = 1;
  options.world_points = input.size () % 2 == 1; // any choice that the same input makes again
  if (input.size () % 3 == 0)
    options.intrinsics = {10.0, 10.0, 4.5, 3.5};
  LabelledView view;
  try
  {
    view = readPcdView (file.path (), options);
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  check (view);
  return (true);
}
