// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_report.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

using namespace pcl::cosection;

namespace {

std::string
lineOf (const PhysicalBody& body)
{
  std::ostringstream text;
  text.precision (3);
  text << body.name << ": " << body.mass_kg << " kg, " << counted (body.parts.size (), "part") << " of "
       << body.parts_volume_m3 / body.volume_m3 << " times its volume, up to " << 1000.0 * body.excess_m
       << " mm beyond it";
  if (body.missing_m > 0.0)
    text << " and " << 1000.0 * body.missing_m << " mm short of it";
  return (text.str ());
}

} // namespace

void
report (const ExportReport& exported, const std::string& folder, Terminal& terminal)
{
  for (const std::string& warning : exported.scene.warnings)
    terminal.warning (warning);
  for (const PhysicalBody& body : exported.scene.bodies)
    if (!body.isStatic ())
      terminal.result (lineOf (body));
  for (const std::string& file : exported.files)
    terminal.detail ("wrote " + file);
  terminal.result ("wrote " + counted (exported.files.size (), "file") + " into " + folder);
}

void
declareExport (OptionGroup& output, std::vector<std::string>& formats)
{
  output.add (
      "--export FORMAT", formats, oneOf (exportFormats ()),
      "Write rigid bodies for simulators into OUTPUT/export as well, as pcl_cosection_export does: urdf, sdf, mjcf, "
      "gltf, usda or moveit; repeatable");
}

bool
anyCompleted (const SceneResult& scene)
{
  return (std::any_of (scene.objects.begin (), scene.objects.end (),
                       [] (const ObjectResult& object) { return (object.error.empty ()); }));
}

void
exportBeside (const std::string& result, const std::vector<std::string>& formats, int threads, Terminal& terminal)
{
  if (formats.empty ())
    return;
  ExportSettings settings;
  settings.formats = formats;
  settings.physics.threads = threads;
  const std::string folder = (std::filesystem::path (result) / "export").string ();
  report (exportScene (result, folder, settings), folder, terminal);
}
