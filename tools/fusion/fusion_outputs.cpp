// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_outputs.h"

#include "method_json.h"
#include "output_files.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

using namespace pcl::cosection;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/** \brief The stamp as trajectories have it. */
std::string
folderName (double stamp)
{
  const bool whole = stamp == std::floor (stamp) && std::abs (stamp) < 1e15;
  std::ostringstream text;
  text << std::fixed << std::setprecision (whole ? 0 : 6) << stamp;
  return (text.str ());
}

/** \brief What a run that was killed left behind. */
bool
isTemporary (const std::string& name)
{
  return (name.rfind (temporary_prefix, 0) == 0 && name.find (".tmp") != std::string::npos);
}

bool
isMesh (const std::string& name)
{
  return (name == "background.ply" || (name.rfind ("object_", 0) == 0 && endsWith (name, ".ply")));
}

bool
isTrajectory (const std::string& name)
{
  return (name == "camera.txt" || (name.rfind ("object_", 0) == 0 && endsWith (name, ".txt")));
}

std::vector<fs::path>
entriesOf (const fs::path& folder)
{
  std::error_code ignored;
  std::vector<fs::path> entries;
  for (fs::directory_iterator entry (folder, ignored), end; entry != end; entry.increment (ignored))
    entries.push_back (entry->path ());
  return (entries);
}

/** \brief Remove the files that \a isOurs, and the folder if nothing is left in it. */
void
removeFiles (const fs::path& folder, bool (*isOurs) (const std::string& name))
{
  std::error_code ignored;
  for (const fs::path& file : entriesOf (folder))
    if (isTemporary (file.filename ().string ()) || isOurs (file.filename ().string ()))
      fs::remove (file, ignored);
  if (!fs::is_symlink (folder, ignored))
    fs::remove (folder, ignored); // fails if it is not empty, as it should
}

void
removeEarlierRun (const fs::path& folder)
{
  std::error_code ignored;
  removeFiles (folder / "mesh", isMesh);
  removeFiles (folder / "trajectory", isTrajectory);
  for (const fs::path& keyframe : entriesOf (folder / "keyframes"))
    removeFiles (keyframe, isMesh);
  fs::remove (folder / "keyframes", ignored);
  fs::remove (folder / "summary.json", ignored);
  for (const fs::path& file : entriesOf (folder))
    if (isTemporary (file.filename ().string ()))
      fs::remove (file, ignored);
}

/** \brief Files that are read; empty names are left out. */
std::vector<std::string>
inputFiles (const FusionSettings& settings)
{
  std::vector<std::string> files{settings.camera_trajectory, settings.ignored.mask,
                                 configurationFile (settings.arguments)};
  for (const auto& [id, file] : settings.object_trajectories)
    files.push_back (file);
  if (settings.network)
    files.insert (files.end (),
                  {settings.network->network.model, settings.network->network.config, settings.network->class_names});
  return (files);
}

/** \throws UsageError if the further summary would overwrite an input, or what the run writes */
void
checkJson (const FusionSettings& settings)
{
  std::vector<std::string> inputs = inputFiles (settings);
  inputs.erase (std::remove (inputs.begin (), inputs.end (), ""), inputs.end ());
  refuseToOverwrite (inputs, {settings.json});
  std::error_code failure;
  for (const std::string& input : {settings.dataset, settings.masks})
    if (!input.empty () && fs::exists (settings.json, failure) && isWithin (settings.json, input) &&
        !isWithin (settings.json, settings.output))
      throw UsageError (settings.json + " would be overwritten: it is part of the input " + input);
  for (const char* folder : {"mesh", "trajectory", "keyframes"})
    if (isWithin (settings.json, (fs::path (settings.output) / folder).string ()))
      throw UsageError ("--json " + settings.json + " is where the run writes other files; give another name");
  if (!isWithin (settings.json, settings.output))
    requireWritable (settings.json);
}

Json
parameters (const FusionSettings& settings)
{
  Json result;
  result["dataset"] = settings.dataset;
  const SequenceSource& source = settings.source; // for who reads the images again; what was found out is empty
  result["images"] = {{"format", settings.format},
                      {"depth_dir", source.depth_folder},
                      {"depth_scale", source.depth_scale},
                      {"intrinsics", source.intrinsics ? Json (*source.intrinsics) : Json ()}};
  result["camera_trajectory"] = settings.camera_trajectory;
  result["object_trajectories"] = Json::object ();
  for (const auto& [id, file] : settings.object_trajectories)
    result["object_trajectories"][std::to_string (id)] = file;
  result["masks"] = settings.masks;
  result["mask_ids"] = settings.mask_ids;
  result["segmentation"] = settings.segmentation;
  if (settings.network)
    result["network"] = networkJson (*settings.network);
  result["ignored_regions"] = settings.ignored.regions;
  result["ignored_mask"] = settings.ignored.mask;
  result["frames"] = {settings.fusion.frames.first,
                      settings.fusion.frames.last == FrameRange ().last ? Json () : Json (settings.fusion.frames.last)};
  result["preset"] = settings.preset.empty () ? "default" : settings.preset;
  result["keyframe_every"] = settings.fusion.keyframe_every;
  result["max_views"] = settings.fusion.backend.max_views;
  result["max_depth_m"] = settings.fusion.keyframe.max_depth_m;
  addMethod (settings.fusion.backend.method, result);
  if (settings.background_block)
    result["background_block_vox"] = *settings.background_block;
  return (result);
}

/** \brief The background: how it was solved; several blocks in one. */
Json
backgroundJson (const SceneResult& scene)
{
  Json result = {{"vertices", scene.background.vertices.size ()}};
  if (scene.background_pieces.empty ())
    return (result);
  Eigen::AlignedBox3d box;
  SolverSummary solver;
  solver.termination = Termination::Converged;
  for (const BackgroundResult& piece : scene.background_pieces)
  {
    const VoxelGrid& grid = piece.signed_distance->grid;
    box.extend (grid.origin_m).extend (grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1));
    solver.iterations = std::max (solver.iterations, piece.solver.iterations);
    solver.energy = piece.solver.energy;
    if (!piece.solver.converged ())
      solver.termination = piece.solver.termination;
  }
  const double voxel_size_m = scene.background_pieces[0].signed_distance->grid.voxel_size_m;
  const Eigen::Vector3i dims = (box.sizes () / voxel_size_m).array ().round ().cast<int> () + 1;
  result["voxel_size_m"] = voxel_size_m;
  result["dimensions"] = {dims.x (), dims.y (), dims.z ()};
  result["solver"] = solverJson (solver);
  if (scene.background_pieces.size () > 1)
  {
    result["solver"].erase ("energy"); // there is none of the whole
    result["blocks"] = scene.background_pieces.size ();
  }
  return (result);
}

} // namespace

FusionOutputs::FusionOutputs (const FusionSettings& settings) : settings_ (settings), folder_ (settings.output)
{
  std::vector<std::string> inputs = inputFiles (settings);
  inputs.insert (inputs.end (), {settings.dataset, settings.masks});
  for (const std::string& input : inputs)
    if (!input.empty () && isWithin (input, settings.output))
      throw UsageError ("OUTPUT " + settings.output + " would overwrite the input " + input + "; give another folder");
  std::error_code failure;
  if (fs::exists (folder_, failure) && !fs::is_directory (folder_, failure))
    throw IoError (settings.output + ": is a file; OUTPUT must be a folder");
  if (!settings.json.empty ())
    checkJson (settings);
}

void
FusionOutputs::begin ()
{
  makeFolder (folder_);
  requireWritableFolder (settings_.output, settings_.output);
  if (!settings_.json.empty ())
    requireWritable (settings_.json); // it may be in that folder
  removeEarlierRun (folder_);
  begun_ = true;
}

void
FusionOutputs::writeKeyframe (const KeyframeReport& keyframe) const
{
  const fs::path folder = folder_ / "keyframes" / folderName (keyframe.stamp);
  makeFolder (folder);
  if (!keyframe.scene.background.empty ())
    saveMesh (keyframe.scene.background, (folder / "background.ply").string ());
  for (const ObjectResult& object : keyframe.scene.objects)
    if (object.error.empty ())
      saveMesh (object.mesh, (folder / ("object_" + std::to_string (object.id) + ".ply")).string ());
}

std::vector<std::string>
FusionOutputs::write (const FusionResult& result) const
{
  std::vector<std::string> files;
  const fs::path mesh = folder_ / "mesh";
  const fs::path trajectory = folder_ / "trajectory";
  makeFolder (mesh);
  makeFolder (trajectory);
  const auto write = [&] (const fs::path& file, auto&& save) {
    save (file.string ());
    files.push_back (file.string ());
  };
  write (trajectory / "camera.txt", [&] (const std::string& file) { saveTrajectory (result.camera, file); });
  for (const auto& [id, object] : result.objects)
    if (!object.trajectory.empty ())
      write (trajectory / ("object_" + std::to_string (id) + ".txt"),
             [&, &o = object] (const std::string& file) { saveTrajectory (o.trajectory, file); });
  if (!result.scene.background.empty ())
    write (mesh / "background.ply", [&] (const std::string& file) { saveMesh (result.scene.background, file); });
  for (const ObjectResult& object : result.scene.objects)
    if (object.error.empty ())
      write (mesh / ("object_" + std::to_string (object.id) + ".ply"),
             [&] (const std::string& file) { saveMesh (object.mesh, file); });
  for (const auto& [id, object] : result.objects)
    if (!object.tsdf.empty ())
      write (mesh / ("object_" + std::to_string (id) + "_tsdf.ply"),
             [&, &o = object] (const std::string& file) { saveMesh (o.tsdf, file); });
  return (files);
}

void
FusionOutputs::writeSummary (const FusionResult& result) const
{
  Json summary;
  summary["timings_s"] = result.timings_s;
  const double total = result.timings_s.at ("total");
  const double before_final = total - result.timings_s.at ("final_solve") - result.timings_s.at ("write");
  summary["frames_per_second"] = static_cast<double> (result.frames) / std::max (1e-9, before_final);
  summary["frames"] = result.frames;
  summary["frames_left_out"] = result.frames_left_out;
  summary["keyframes"] = result.keyframes;
  summary["kept_keyframes"] = result.kept_keyframes;
  summary["camera"] = cameraJson (result.intrinsics);
  summary["parameters"] = parameters (settings_);
  summary["objects"] = Json::array ();
  summary["failed"] = Json::array ();
  for (const ObjectResult& object : result.scene.objects)
    if (object.error.empty ())
    {
      Json entry = objectJson (object);
      entry.erase ("label");
      entry["mask_ids"] = Json::array ();
      if (!result.tracked || settings_.fusion.front_end.persistent_ids)
        entry["mask_ids"].push_back (object.id); // else they differ from mask to mask
      const auto fused = result.objects.find (object.id);
      entry["frames_tracked"] = fused == result.objects.end () ? 0 : fused->second.trajectory.size ();
      if (fused != result.objects.end () && fused->second.best_class)
        entry.update (classJson (fused->second.best_class->class_id, fused->second.best_class->class_name,
                                 fused->second.best_class->score));
      summary["objects"].push_back (entry);
    }
    else
      summary["failed"].push_back ({{"id", object.id}, {"error", object.error}});
  summary["support_planes"] = planesJson (result.scene.planes);
  summary["background"] = backgroundJson (result.scene);
  if (result.tracked)
    summary["events"] = result.events;
  summary["warnings"] = result.warnings;
  saveJson (summary, (folder_ / "summary.json").string ());
  if (!settings_.json.empty ())
    saveJson (summary, settings_.json);
}

void
FusionOutputs::writeFailure (const std::string& error) const
{
  saveFailure (error, parameters (settings_), {},
               {settings_.json, begun_ ? (folder_ / "summary.json").string () : std::string ()});
}
