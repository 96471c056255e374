// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "new_folder.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <unistd.h>

namespace fs = std::filesystem;

namespace pcl::cosection {

NewFolder::NewFolder (const std::string& path) : path_ (fs::path (path).lexically_normal ())
{
  if (!path_.has_filename ())
    path_ = path_.parent_path ();
  std::error_code failure;
  if (path_.filename () == "." || path_.filename () == ".." || path_.empty ())
    throw IoError (path + ": cannot be replaced; give the name of a new folder");
  if (fs::exists (fs::symlink_status (path_, failure)))
  {
    if (!fs::is_directory (path_, failure) || !fs::is_empty (path_, failure))
      throw IoError (path + ": is there already; give the name of a new folder");
  }
  const fs::path parent = path_.has_parent_path () ? path_.parent_path () : fs::path (".");
  fs::create_directories (parent, failure);
  const std::string prefix = "." + path_.filename ().string () + "_";
  for (fs::directory_iterator entry (parent, failure), end; !failure && entry != end; entry.increment (failure))
  {
    const std::string other = entry->path ().filename ().string ();
    const std::size_t random = other.find ('_', prefix.size ());
    std::error_code ignored;
    if (isOfGoneProcess (other, prefix) && other.size () - random == 7 && other.find ('_', random + 1) == other.npos)
      fs::remove_all (entry->path (), ignored);
  }
  std::string name = (parent / (prefix + std::to_string (getpid ()) + "_XXXXXX")).string ();
  if (!mkdtemp (name.data ()))
    throw IoError (path + ": cannot be made: " + std::strerror (errno));
  temporary_ = name;
  fs::permissions (temporary_, fs::perms::all & ~(fs::perms::group_write | fs::perms::others_write), failure);
}

NewFolder::~NewFolder ()
{
  std::error_code ignored;
  if (!temporary_.empty ())
    fs::remove_all (temporary_, ignored);
}

void
NewFolder::makeFolder (const std::string& name) const
{
  std::error_code failure;
  fs::create_directory (temporary_ / name, failure);
  if (failure)
    throw IoError ((path_ / name).string () + ": cannot be made: " + failure.message ());
}

void
NewFolder::writeText (const std::string& name, const std::string& text) const
{
  try
  {
    writeBytes (file (name), text);
  }
  catch (const std::system_error& error)
  {
    throw IoError (file (name) + ": cannot be written: " + error.code ().message ());
  }
}

void
NewFolder::fill (const std::function<void ()>& write)
{
  try
  {
    write ();
  }
  catch (const IoError& error)
  {
    std::string message = error.what ();
    const std::string temporary = temporary_.string ();
    for (std::size_t at; (at = message.find (temporary)) != std::string::npos;)
      message.replace (at, temporary.size (), path_.string ());
    throw IoError (message);
  }
  std::error_code failure;
  fs::remove (path_, failure); // an empty folder
  fs::rename (temporary_, path_, failure);
  if (failure)
    throw IoError (path_.string () + ": cannot be made: " + failure.message ());
  temporary_.clear ();
}

} // namespace pcl::cosection
