// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a PCD or PLY file: its header and its points in every encoding.

#include "fuzz_target.h"
#include "memory_file.h"
#include "seeds/pcd_seeds.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

namespace {

constexpr std::uint32_t background = 2, ignored = 3; // labels, where the options name them

/** \brief Options that any input has, and the same input again. */
PcdViewOptions
optionsFor (std::size_t size)
{
  PcdViewOptions options;
  options.threads = 1;
  options.world_points = size % 2 == 1;
  if (size % 3 == 0)
    options.intrinsics = {10.0, 10.0, 4.5, 3.5};
  if (size % 4 > 1) // below the things, in the sensor's frame and in survey coordinates
    options.planes = {{0.0, -1.0, 0.0, 0.5}, {0.0, 0.0, 2.0, -2.0 * 347.5}};
  if (size % 5 == 0)
    options.axes = SensorAxes::OpenGl;
  if (size % 7 == 0)
    options.background_labels = {background};
  if (size % 11 == 0)
    options.ignored_labels = {ignored};
  if (size % 13 == 0)
    options.origin = {512430.0, 5405590.0, 348.0};
  return (options);
}

void
checkView (const DepthView& view)
{
  view.camera.validate ();
  fuzz::require (view.T_world_sensor.matrix ().allFinite (), "the pose of the sensor is finite");
  fuzz::require (view.depth.size () == std::size_t (view.camera.width) * view.camera.height, "a depth for every pixel");
  for (const float depth : view.depth)
    fuzz::require (std::isnan (depth) || (depth > 0.0f && std::isfinite (depth)), "depths are positive or missing");
}

void
check (const LabelledView& view, const PcdViewOptions& options)
{
  fuzz::require (!view.objects.empty (), "a view has points");
  fuzz::require (view.origin.allFinite (), "the origin is finite");
  fuzz::require (!options.origin || std::equal (options.origin->begin (), options.origin->end (), view.origin.data ()),
                 "the origin is the given one");
  for (const auto& [label, object] : view.objects)
  {
    fuzz::require (!view.has_labels || options.ignored_labels.empty () || label != ignored,
                   "points that are to be ignored are in no object");
    fuzz::require (object.readings >= object.points.size (), "a point is a reading");
    for (const OrientedPoint& point : object.points)
    {
      fuzz::require (point.position.allFinite (), "positions are finite");
      fuzz::require (std::abs (point.normal.norm () - 1.0f) < 1e-3f, "normals have unit length");
    }
  }
  if (view.view)
    checkView (*view.view);
  for (const DepthView& other : view.other_views)
    checkView (other);
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
  return {"VERSION",
          "FIELDS",
          "COLUMNS",
          "SIZE",
          "TYPE",
          "COUNT",
          "WIDTH",
          "HEIGHT",
          "VIEWPOINT",
          "POINTS",
          "DATA",
          "ascii",
          "binary",
          "binary_compressed",
          "x",
          "y",
          "z",
          "rgb",
          "rgba",
          "label",
          "_",
          "normal_x",
          "normal_y",
          "normal_z",
          "intensity",
          "curvature",
          "F",
          "U",
          "I",
          "1",
          "2",
          "4",
          "8",
          "#",
          "# .PCD v0.7",
          "\n",
          "ply",
          "format ascii 1.0",
          "binary_little_endian",
          "binary_big_endian",
          "element vertex",
          "element face",
          "element camera",
          "property",
          "list",
          "char",
          "uchar",
          "short",
          "ushort",
          "int",
          "uint",
          "float",
          "double",
          "nx",
          "ny",
          "nz",
          "red",
          "green",
          "blue",
          "alpha",
          "scalar_Label",
          "classification",
          "vertex_indices",
          "view_px",
          "view_pz",
          "x_axisx",
          "y_axisz",
          "viewportx",
          "viewporty",
          "comment",
          "obj_info",
          "end_header",
          "512434",
          "5405590.25",
          "-0.5",
          "0.25"};
}

bool
fuzz::accepts (const std::string& input)
{
  static MemoryFile file;
  file.set (input);
  const PcdViewOptions options = optionsFor (input.size ());
  LabelledView view;
  try
  {
    view = readPcdView (file.path (), options);
  }
  catch (const Error& error)
  {
    require (dynamic_cast<const InvalidArgument*> (&error) == nullptr, "a file is not refused for the options");
    requireMessage (error.what ());
    return (false);
  }
  check (view, options);
  return (true);
}
