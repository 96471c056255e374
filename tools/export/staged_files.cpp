// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "staged_files.h"

#include "output_files.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>

#include <system_error>
#include <utility>

#include <unistd.h>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

/** \brief Put a file in the place of another one, or of what a link points to. */
void
move (const fs::path& from, const fs::path& to)
{
  const fs::path target = followLinks (to.string ());
  std::error_code failure;
  fs::rename (from, target, failure);
  if (!failure)
    return;
  if (failure != std::errc::cross_device_link)
    throw IoError ("cannot write '" + to.string () + "': " + failure.message ());
  writeAtomically (to.string (), [&] (const std::string& temporary) {
    fs::copy_file (from, temporary, fs::copy_options::overwrite_existing);
  });
}

} // namespace

StagedFiles::StagedFiles (const std::string& output) : output_ (output)
{
  std::error_code failure;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry (output_, failure), end; !failure && entry != end; entry.increment (failure))
    if (isOfGoneProcess (entry->path ().filename ().string (), temporary_prefix) && entry->is_directory (failure))
      left.push_back (entry->path ());
  for (const fs::path& folder : left)
    fs::remove_all (folder, failure);
  const fs::path staging = output_ / (std::string (temporary_prefix) + std::to_string (getpid ()) + "-files.tmp");
  if (!fs::create_directory (staging, failure))
    throw IoError ("cannot make the folder '" + staging.string () +
                   "': " + (failure ? failure.message () : "it is there"));
  staging_ = staging;
}

StagedFiles::~StagedFiles ()
{
  std::error_code ignored;
  fs::remove_all (staging_, ignored);
}

std::vector<std::string>
StagedFiles::publish (const std::vector<std::string>& files) const
{
  std::vector<std::pair<fs::path, fs::path>> first, last;
  std::vector<std::string> places;
  for (const std::string& file : files)
  {
    const fs::path name = fs::path (file).lexically_relative (staging_);
    const fs::path place = output_ / name;
    makeFolder (place.parent_path ());
    requireWritable (place.string ());
    (name.has_parent_path () ? first : last).emplace_back (file, place);
    places.push_back (place.string ());
  }
  std::error_code ignored;
  for (const auto& [from, to] : last)
    if (!fs::is_symlink (to, ignored))
      fs::remove (to, ignored);
  for (const auto* moved : {&first, &last})
    for (const auto& [from, to] : *moved)
      move (from, to);
  return (places);
}
