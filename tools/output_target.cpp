// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "output_target.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/sdf_io.h>

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace
{

/** \brief Prove by doing it that a file can be made in \a folder. */
void
checkFolder (const std::string& path, const fs::path& folder)
{
  std::error_code failure;
  if (!fs::is_directory (folder, failure))
    throw IoError (path + ": cannot be written, there is no folder " + folder.string ());
  std::string probe = (folder / ".pcl_cosection_XXXXXX").string ();
  const int file = mkstemp (probe.data ());
  if (file < 0)
    throw IoError (path + ": cannot be written: " + std::strerror (errno));
  close (file);
  unlink (probe.c_str ());
}

void
checkFile (const std::string& path)
{
  std::error_code failure;
  const fs::file_status status = fs::status (path, failure);
  if (fs::is_directory (status))
    throw IoError (path + ": cannot be written, it is a folder");
  if (fs::exists (status) && !fs::is_regular_file (status))
    throw IoError (path + ": cannot be written, it is not a regular file");
  const fs::path parent = fs::path (path).parent_path ();
  checkFolder (path, parent.empty () ? fs::path (".") : parent);
}

} // namespace

OutputTarget::OutputTarget (const Settings& settings)
    : output_ (settings.output)
    , format_ (settings.format)
    , save_sdf_ (settings.save_sdf)
    , single_file_ (!meshExtension (settings.output).empty ())
{
  if (!settings.json.empty ())
    checkFile (settings.json);
  if (single_file_)
  {
    checkFile (output_);
    return;
  }
  std::error_code failure;
  if (fs::exists (output_, failure) && !fs::is_directory (output_, failure))
    throw IoError (output_ + ": is a file; OUTPUT must be a folder, or a file ending in .ply, .stl or .obj");
  made_folder_ = fs::create_directories (output_, failure);
  if (failure)
    throw IoError (output_ + ": the folder cannot be made: " + failure.message ());
  checkFolder (output_, output_);
}

OutputTarget::~OutputTarget ()
{
  std::error_code ignored;
  if (made_folder_)
    fs::remove (output_, ignored); // fails if it is not empty, as it should
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
  {
    if (!object.error.empty ())
      continue;
    if (!single_file_)
      save (object.mesh, objectPath (object, format_, only));
    else if (all.empty ())
      all = object.mesh;
    else
      appendMesh (all, object.mesh);
    for (const auto& [mesh, name] : {std::pair{&object.hull, "_hull"}, std::pair{&object.inner_bound, "_inner"},
                                     std::pair{&object.outer_bound, "_outer"}})
      if (!mesh->empty ())
        save (*mesh, objectPath (object, format_, only, name));
    if (save_sdf_ && object.signed_distance)
    {
      saveSignedDistance (*object.signed_distance, objectPath (object, "vti", only));
      files.push_back (objectPath (object, "vti", only));
    }
  }
  if (single_file_ && !all.empty ())
    save (all, output_);
  if (!single_file_ && !result.background.empty ())
    save (result.background, (fs::path (output_) / ("background." + format_)).string ());
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
