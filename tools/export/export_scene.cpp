// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_scene.h"

#include "arguments.h"
#include "completed_result.h"
#include "output_files.h"

#include "pcl_cosection/physics/formats/body_samples.h"
#include "pcl_cosection/physics/formats/scene_writers.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <filesystem>
#include <utility>

using namespace pcl::cosection;

namespace {

using Writer = std::vector<std::string> (*) (const PhysicalScene&, const std::string&);

const std::vector<std::pair<std::string, Writer>> writers = {{"urdf", writeUrdf}, {"sdf", writeSdf},
                                                             {"mjcf", writeMjcf}, {"gltf", writeGltf},
                                                             {"usda", writeUsd},  {"moveit", writePlanningScene}};

constexpr double margin_voxels = 5.0; // of signed distances

/** \brief Write points and signed distances of the objects, as far as they are wanted. \return the files */
std::vector<std::string>
writeSamples (const PhysicalScene& scene, const CompletedScene& completed, const std::string& output,
              const ExportSettings& settings)
{
  SceneFolder folder (output);
  for (std::size_t n = 0; n < completed.objects.size (); ++n) // the bodies of objects are the first ones
  {
    const PhysicalBody& body = scene.bodies[n];
    const double voxel_size_m = completed.objects[n].voxel_size_m;
    if (settings.points > 0)
      writeBodyPoints (body, settings.points, settings.physics.threads, folder);
    if (settings.save_sdf)
      writeBodyDistance (body, voxel_size_m, settings.sdf_margin_m.value_or (margin_voxels * voxel_size_m),
                         settings.physics.threads, folder);
  }
  return (folder.finish ());
}

void
requireVoxelSizes (const CompletedScene& completed, const std::string& result)
{
  for (const CompletedObject& object : completed.objects)
    if (!(object.voxel_size_m > 0.0))
      throw IoError (result + "/summary.json: object " + std::to_string (object.id) +
                     " has no voxel_size_m; --save-sdf needs it");
}

} // namespace

const std::vector<std::string>&
exportFormats ()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, writer] : writers)
      list.push_back (name);
    return (list);
  }();
  return (names);
}

ExportReport
exportScene (const std::string& result, const std::string& output, const ExportSettings& settings)
{
  CompletedResult completed = readCompletedResult (result);
  for (const auto& [id, mass] : settings.physics.masses_kg)
    if (std::none_of (completed.scene.objects.begin (), completed.scene.objects.end (),
                      [id = id] (const CompletedObject& object) { return (object.id == id); }))
      throw UsageError ("--mass " + std::to_string (id) + ": there is no such object in " + result);
  if (settings.save_sdf)
    requireVoxelSizes (completed.scene, result);
  if (isSameFile (result, output))
    throw UsageError (output + ": is RESULT; give another folder");
  ExportReport report;
  report.scene = buildPhysicalScene (completed.scene, settings.physics);
  report.scene.T_result_scene.pretranslate (completed.origin);
  report.scene.warnings.insert (report.scene.warnings.begin (), completed.warnings.begin (), completed.warnings.end ());
  makeFolder (output);
  requireWritableFolder (output, output);
  const std::vector<std::string> samples = writeSamples (report.scene, completed.scene, output, settings);
  for (const auto& [name, writer] : writers)
    if (std::find (settings.formats.begin (), settings.formats.end (), name) != settings.formats.end ())
      for (const std::string& file : writer (report.scene, output))
        if (std::find (report.files.begin (), report.files.end (), file) == report.files.end ())
          report.files.push_back (file);
  report.files.insert (report.files.end (), samples.begin (), samples.end ());
  return (report);
}
