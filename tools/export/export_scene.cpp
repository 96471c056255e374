// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_scene.h"

#include "arguments.h"
#include "completed_result.h"
#include "output_files.h"
#include "staged_files.h"

#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/place_text.h"
#include "pcl_cosection/physics/formats/body_samples.h"
#include "pcl_cosection/physics/formats/mesh_files.h"
#include "pcl_cosection/physics/formats/scene_writers.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;
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

/** \brief Write all files, which take their places together. \param[in] stopIfAsked throws \return the files */
std::vector<std::string>
writeFiles (const PhysicalScene& scene, const CompletedScene& completed, const std::string& output,
            const ExportSettings& settings, const std::function<void ()>& stopIfAsked)
{
  const StagedFiles staged (output);
  try
  {
    std::vector<std::string> files;
    const std::vector<std::string> samples = writeSamples (scene, completed, staged.folder (), settings);
    for (const auto& [name, writer] : writers)
      if (std::find (settings.formats.begin (), settings.formats.end (), name) != settings.formats.end ())
      {
        stopIfAsked ();
        for (const std::string& file : writer (scene, staged.folder ()))
          if (std::find (files.begin (), files.end (), file) == files.end ())
            files.push_back (file);
      }
    stopIfAsked ();
    files.insert (files.end (), samples.begin (), samples.end ());
    return (staged.publish (files));
  }
  catch (const IoError& error)
  {
    std::string text = error.what ();
    if (const std::size_t at = text.find (staged.folder ()); at != std::string::npos)
      text.replace (at, staged.folder ().size (), output); // where the file would have been in the end
    throw IoError (text);
  }
}

/** \brief Models of an earlier export that name files of meshes. \param[in] written now */
std::vector<std::string>
formerModels (const std::string& output, const std::vector<std::string>& written)
{
  std::vector<std::string> former;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator (output, failure))
  {
    const std::string path = entry.path ().string (), extension = entry.path ().extension ().string ();
    if ((extension == ".urdf" || extension == ".sdf" || extension == ".xml") &&
        std::find (written.begin (), written.end (), path) == written.end ())
      former.push_back (path);
  }
  std::sort (former.begin (), former.end ());
  return (former);
}

/** \brief buildPhysicalScene (), whose errors name the folder. */
PhysicalScene
build (const CompletedScene& scene, const PhysicsOptions& options, const std::string& result)
try
{
  return (buildPhysicalScene (scene, options));
}
catch (const InvalidArgument& error)
{
  throw InvalidArgument (result + ": " + error.what ());
}
catch (const DegenerateInput& error)
{
  throw DegenerateInput (result + ": " + error.what ());
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
exportScene (const std::string& result, const std::string& output, const ExportSettings& settings,
             const std::function<bool ()>& go_on)
{
  const auto stopIfAsked = [&go_on] {
    if (go_on && !go_on ())
      throw Cancelled ("interrupted");
  };
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
  report.scene = build (completed.scene, settings.physics, result);
  report.scene.T_result_scene.pretranslate (completed.origin);
  if (!completed.origin.isZero (0.0))
    completed.warnings.push_back (result + ": is far from its origin; the scene is relative to " +
                                  placeText (completed.origin) + ", as T_result_scene in scene.json has it");
  report.scene.warnings.insert (report.scene.warnings.begin (), completed.warnings.begin (), completed.warnings.end ());
  stopIfAsked ();
  std::error_code unknown;
  const bool is_new = !fs::exists (fs::symlink_status (output, unknown));
  makeFolder (output);
  requireWritableFolder (output, output);
  try
  {
    report.files = writeFiles (report.scene, completed.scene, output, settings, stopIfAsked);
  }
  catch (...)
  {
    std::error_code ignored;
    if (is_new)
      fs::remove (output, ignored); // unless it is in use
    throw;
  }
  if (std::any_of (report.files.begin (), report.files.end (), [] (const std::string& file) {
        return (fs::path (file).parent_path ().filename () == mesh_folder);
      }))
  {
    removeFormerParts (report.scene, output);
    if (const std::vector<std::string> former = formerModels (output, report.files); !former.empty ())
      report.scene.warnings.push_back (
          firstAndMore (former) +
          ": of an earlier export; the meshes that they name are of this one now. Give all formats in one run");
  }
  return (report);
}
