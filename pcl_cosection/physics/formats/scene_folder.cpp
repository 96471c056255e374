// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_folder.h"

#include "pcl_cosection/common/files.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace pcl::cosection {

SceneFolder::~SceneFolder ()
{
  std::error_code ignored;
  for (const std::string& path : paths_)
    std::filesystem::remove (path, ignored);
  for (const std::string& folder : made_folders_)
    std::filesystem::remove (folder, ignored); // fails if somebody else wrote into it
}

std::string
SceneFolder::pathOf (const std::string& name)
{
  const std::filesystem::path path = std::filesystem::path (folder_) / name;
  if (const std::filesystem::path parent = path.parent_path (); parent != std::filesystem::path (folder_))
  {
    std::error_code error;
    if (std::filesystem::create_directory (parent, error))
      made_folders_.push_back (parent.string ());
    if (error)
      throw IoError ("cannot make the folder '" + parent.string () + "': " + error.message ());
  }
  return path.string ();
}

void
SceneFolder::write (const std::string& name, const std::string& bytes)
{
  const std::string path = pathOf (name);
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, bytes); });
  paths_.push_back (path);
}

void
SceneFolder::write (const std::string& name, const TriangleMesh& mesh)
{
  const std::string path = pathOf (name);
  saveMesh (mesh, path);
  paths_.push_back (path);
}

void
SceneFolder::write (const std::string& name, const SignedDistanceField& field)
{
  const std::string path = pathOf (name);
  saveSignedDistance (field, path);
  paths_.push_back (path);
}

bool
SceneFolder::has (const std::string& name) const
{
  std::error_code ignored;
  return std::filesystem::exists (std::filesystem::path (folder_) / name, ignored);
}

std::vector<std::string>
SceneFolder::finish ()
{
  made_folders_.clear ();
  return std::exchange (paths_, {});
}

} // namespace pcl::cosection
