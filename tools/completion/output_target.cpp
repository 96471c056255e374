// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_target.h"

#include "output_files.h"

#include "pcl_cosection/common/atomic_file.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;

OutputFolder::OutputFolder (const std::string& path)
{
  if (path.empty ())
    return;
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

OutputFolder::~OutputFolder ()
{
  removeMade ();
}

void
OutputFolder::removeMade () const
{
  std::error_code ignored;
  for (auto name = made_.rbegin (); name != made_.rend (); ++name)
    fs::remove (*name, ignored); // fails if it is not empty, as it should
}

OutputTarget::OutputTarget (const Settings& settings)
    : output_ (settings.output)
    , format_ (settings.format)
    , save_sdf_ (settings.save_sdf)
    , save_more_ (settings.method.compute_hull || settings.method.compute_bounds)
    , single_file_ (!meshExtension (settings.output).empty ())
    , folder_ (single_file_ ? "" : settings.output)
{
  if (!settings.json.empty ())
    requireWritable (settings.json);
  if (single_file_)
    requireWritable (output_);
  else
    requireWritableFolder (output_, output_);
  refuseToOverwrite (settings);
}

bool
OutputTarget::isOwnName (const fs::path& name) const
{
  const std::string stem = name.stem ().string (), extension = name.extension ().string ();
  const bool is_sdf = save_sdf_ && extension == ".vti";
  const bool is_beside = is_sdf || (save_more_ && extension == "." + format_);
  if (single_file_)
    return (name == fs::path (output_).filename () || (is_beside && stem.rfind (fs::path (output_).stem (), 0) == 0));
  return ((is_sdf || extension == "." + format_) && (stem == "background" || stem.rfind ("object_", 0) == 0));
}

void
OutputTarget::refuseToOverwrite (const Settings& settings) const
{
  const fs::path folder = single_file_ ? folderOf (output_) : fs::path (output_);
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
  std::vector<std::string> inputs = settings.inputs;
  inputs.insert (inputs.end (), settings.free_space.begin (), settings.free_space.end ());
  inputs.insert (inputs.end (), settings.obstacles.begin (), settings.obstacles.end ());
  for (const auto& [label, file] : settings.object_trajectories)
    inputs.push_back (file);
  for (const std::string& input : inputs)
  {
    if (isOwn (input))
      throw UsageError (input + ": is an input that " + output_ + " would overwrite; give another OUTPUT");
    if (!settings.json.empty () && isSameFile (input, settings.json))
      throw UsageError (input + ": is an input that --json would overwrite; give another file");
  }
  if (!settings.json.empty () && isOwn (settings.json))
    throw UsageError ("--json " + settings.json + ": is a file for a mesh; give another one");
}

std::vector<std::string>
OutputTarget::write (const SceneResult& result) const
{
  std::vector<std::string> files;
  const auto save = [&files] (const TriangleMesh& mesh, const std::string& path) {
    saveMesh (mesh, path);
    files.push_back (path);
  };
  TriangleMesh all;
  const bool only = result.objects.size () == 1;
  for (const ObjectResult& object : result.objects)
    if (!object.error.empty ())
      continue;
    else if (!single_file_)
      save (object.mesh, objectPath (object, format_, only));
    else if (all.empty ())
      all = object.mesh;
    else
      appendMesh (all, object.mesh);
  if (single_file_ && !all.empty ())
    save (all, output_);
  if (!single_file_ && !result.background.empty ())
    save (result.background, (fs::path (output_) / ("background." + format_)).string ());
  for (const ObjectResult& object : result.objects)
    for (const auto& [mesh, suffix] : {std::pair{&object.hull, "_hull"}, std::pair{&object.inner_bound, "_inner"},
                                       std::pair{&object.outer_bound, "_outer"}})
      if (!mesh->empty ())
        save (*mesh, objectPath (object, format_, only, suffix));
  for (const ObjectResult& object : result.objects) // last: they are large, and the disk may be full
    if (save_sdf_ && object.error.empty () && object.signed_distance)
    {
      files.push_back (objectPath (object, "vti", only));
      saveSignedDistance (*object.signed_distance, files.back ());
    }
  return (files);
}

std::string
OutputTarget::objectPath (const ObjectResult& object, const std::string& extension, bool only,
                          const std::string& suffix) const
{
  const std::string name = "object_" + std::to_string (object.id) + suffix;
  if (!single_file_)
    return ((fs::path (output_) / (name + "." + extension)).string ());
  fs::path path (output_);
  path.replace_extension ();
  return (path.string () + (only ? suffix : "_" + name) + "." + extension);
}
