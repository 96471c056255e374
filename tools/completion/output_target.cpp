// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_target.h"

#include "output_files.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <filesystem>
#include <regex>

namespace fs = std::filesystem;
using namespace pcl::cosection;

/** \brief A folder, made with those above it if there is none. What was made is removed again if nothing was written
 * into it. */
class OutputFolder
{
public:
  explicit OutputFolder (const std::string& path)
  {
    std::error_code failure;
    if (fs::exists (path, failure) && !fs::is_directory (path, failure))
      throw IoError (path + ": is a file; OUTPUT must be a folder, or a file ending in .ply, .stl or .obj");
    fs::path folder = followLinks (path);
    if (!folder.has_filename ()) // "a/b/" is "a/b"
      folder = folder.parent_path ();
    std::vector<fs::path> missing;
    for (; !folder.empty () && !fs::exists (folder, failure); folder = folder.parent_path ())
      missing.push_back (folder);
    std::reverse (missing.begin (), missing.end ());
    for (const fs::path& name : missing)
    {
      if (fs::create_directory (name, failure))
        made_.push_back (name);
      if (!failure)
        continue;
      removeMade ();
      throw IoError (path + ": the folder cannot be made: " + failure.message ());
    }
  }

  OutputFolder (const OutputFolder&) = delete;
  OutputFolder& operator= (const OutputFolder&) = delete;
  ~OutputFolder () { removeMade (); }

private:
  void removeMade () const
  {
    std::error_code ignored;
    for (auto name = made_.rbegin (); name != made_.rend (); ++name)
      fs::remove (*name, ignored); // fails if it is not empty, as it should
  }

  std::vector<fs::path> made_; ///< the deepest one last
};

OutputTarget::OutputTarget (const Settings& settings)
    : settings_ (settings)
    , single_file_ (!meshExtension (settings.output).empty ())
    , folder_ (single_file_ ? nullptr : std::make_shared<OutputFolder> (settings.output))
{
  if (!settings.json.empty ())
    requireWritable (settings.json);
  if (single_file_)
    requireWritable (settings_.output);
  else
    requireWritableFolder (settings_.output, settings_.output);
  refuseToOverwrite ();
}

bool
OutputTarget::isOwnName (const fs::path& name) const
{
  const std::string stem = name.stem ().string (), extension = name.extension ().string ();
  const bool is_sdf = settings_.save_sdf && extension == ".vti";
  const bool is_beside = is_sdf ||
                         ((settings_.save_hull || settings_.save_bounds) && extension == "." + settings_.format);
  if (single_file_)
    return (name == fs::path (settings_.output).filename () ||
            (is_beside && stem.rfind (fs::path (settings_.output).stem (), 0) == 0));
  if (name == "summary.json")
    return (true);
  return ((is_sdf || extension == "." + settings_.format) && (stem == "background" || stem.rfind ("object_", 0) == 0));
}

void
OutputTarget::refuseToOverwrite () const
{
  const fs::path folder = single_file_ ? folderOf (settings_.output) : fs::path (settings_.output);
  std::vector<fs::path> own; // what is there already, be it a link
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator (folder, unreadable))
    if (isOwnName (entry.path ().filename ()))
      own.push_back (entry.path ());
  const auto isOwn = [&] (const fs::path& path) {
    const auto same = [&path] (const fs::path& file) { return (isSameFile (path.string (), file.string ())); };
    const fs::path target = followLinks (path.string ()); // there may be no such file yet
    return ((isOwnName (target.filename ()) && isSameFile (folderOf (target).string (), folder.string ())) ||
            std::any_of (own.begin (), own.end (), same));
  };
  std::vector<std::string> inputs = settings_.inputs;
  inputs.insert (inputs.end (), settings_.free_space.begin (), settings_.free_space.end ());
  inputs.insert (inputs.end (), settings_.obstacles.begin (), settings_.obstacles.end ());
  for (const auto& [label, file] : settings_.object_trajectories)
    inputs.push_back (file);
  for (const auto& [label, file] : settings_.proposals)
    inputs.push_back (file);
  if (const std::string configuration = configurationFile (settings_.arguments); !configuration.empty ())
    inputs.push_back (configuration);
  for (const std::string& input : inputs)
  {
    if (isOwn (input))
      throw UsageError (input + ": is an input that " + settings_.output + " would overwrite; give another OUTPUT");
    if (!settings_.json.empty () && isSameFile (input, settings_.json))
      throw UsageError (input + ": is an input that --json would overwrite; give another file");
  }
  const bool is_summary = !single_file_ && isSameFile (settings_.json, summaryPath ());
  if (!settings_.json.empty () && !is_summary && isOwn (settings_.json))
    throw UsageError ("--json " + settings_.json + ": is a file for a mesh; give another one");
}

std::vector<std::string>
OutputTarget::write (const SceneResult& result, const Eigen::Vector3d& origin) const
{
  const auto originOf = [&] (const ObjectResult& object) { // those with a trajectory are in a frame of their own
    return settings_.object_trajectories.count (object.id) == 0 ? origin : Eigen::Vector3d::Zero ();
  };
  std::vector<std::string> files;
  const auto save = [&] (const TriangleMesh& mesh, const std::string& path, const Eigen::Vector3d& origin_of_mesh) {
    saveMesh (mesh, path, origin_of_mesh);
    files.push_back (path);
  };
  TriangleMesh all;
  const bool only = result.objects.size () == 1;
  for (const ObjectResult& object : result.objects)
    if (!object.error.empty ())
      continue;
    else if (!single_file_)
      save (object.mesh, objectPath (object, settings_.format, only), originOf (object));
    else if (all.empty ())
      all = object.mesh;
    else
      appendMesh (all, object.mesh);
  if (single_file_ && !all.empty ())
    save (all, settings_.output, origin);
  if (!single_file_ && !result.background.empty ())
    save (result.background, (fs::path (settings_.output) / ("background." + settings_.format)).string (), origin);
  for (const ObjectResult& object : result.objects)
    for (const auto& [mesh, suffix] : {std::pair{&object.hull, "_hull"}, std::pair{&object.inner_bound, "_inner"},
                                       std::pair{&object.outer_bound, "_outer"}})
      if (!mesh->empty ())
        save (*mesh, objectPath (object, settings_.format, only, suffix), originOf (object));
  for (const ObjectResult& object : result.objects) // last: they are large, and the disk may be full
    if (settings_.save_sdf && object.error.empty () && object.signed_distance)
    {
      files.push_back (objectPath (object, "vti", only));
      saveSignedDistance (*object.signed_distance, files.back (), originOf (object));
    }
  if (!files.empty ())
    removeFormer (files);
  return (files);
}

void
OutputTarget::removeFormer (const std::vector<std::string>& written) const
{
  if (formerSummary ().empty ())
    return;
  static const std::regex name ("(background|object_[0-9]+(_hull|_inner|_outer)?)\\.(ply|stl|obj|vti)");
  std::error_code failure;
  std::vector<fs::path> former;
  for (const auto& entry : fs::directory_iterator (settings_.output, failure))
    if (const fs::path file = entry.path ().filename ();
        std::regex_match (file.string (), name) && (isOwnName (file) || file.extension () == ".vti"))
      former.push_back (entry.path ());
  for (const fs::path& file : former)
    if (std::none_of (written.begin (), written.end (),
                      [&] (const fs::path& path) { return (path.filename () == file.filename ()); }))
      fs::remove (file, failure);
}

void
OutputTarget::writeSummary (const nlohmann::ordered_json& summary) const
{
  if (!single_file_)
    saveJson (summary, summaryPath ());
  if (!settings_.json.empty () && (single_file_ || !isSameFile (settings_.json, summaryPath ())))
    saveJson (summary, settings_.json);
}

std::string
OutputTarget::formerSummary () const
{
  std::error_code failure;
  return (!single_file_ && fs::exists (summaryPath (), failure) ? summaryPath () : std::string ());
}

std::string
OutputTarget::summaryPath () const
{
  return ((fs::path (settings_.output) / "summary.json").string ());
}

std::string
OutputTarget::objectPath (const ObjectResult& object, const std::string& extension, bool only,
                          const std::string& suffix) const
{
  const std::string name = "object_" + std::to_string (object.id) + suffix;
  if (!single_file_)
    return ((fs::path (settings_.output) / (name + "." + extension)).string ());
  fs::path path (settings_.output);
  path.replace_extension ();
  return (path.string () + (only ? suffix : "_" + name) + "." + extension);
}
