// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_files.h"

#include "arguments.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace fs = std::filesystem;
using namespace pcl::cosection;

fs::path
folderOf (const fs::path& path)
{
  return (path.has_parent_path () ? path.parent_path () : fs::path ("."));
}

bool
endsWith (const std::string& name, const std::string& ending)
{
  return (name.size () > ending.size () && name.compare (name.size () - ending.size (), ending.size (), ending) == 0);
}

bool
isSameFile (const std::string& first, const std::string& second)
{
  const fs::path a (first), b (second);
  std::error_code failure;
  if (fs::exists (a, failure) || fs::exists (b, failure))
    return (fs::equivalent (a, b, failure) && !failure);
  const fs::path behind_a = followLinks (a.string ()), behind_b = followLinks (b.string ());
  return (behind_a.filename () == behind_b.filename () &&
          fs::equivalent (folderOf (behind_a), folderOf (behind_b), failure) && !failure);
}

bool
isWithin (const std::string& path, const std::string& folder)
{
  std::error_code failure;
  // weakly_canonical () leaves a relative path as it is if nothing of it exists.
  const fs::path inner = fs::weakly_canonical (fs::absolute (path, failure), failure);
  const fs::path outer = fs::weakly_canonical (fs::absolute (folder, failure), failure);
  return (std::mismatch (outer.begin (), outer.end (), inner.begin (), inner.end ()).first == outer.end ());
}

void
refuseToOverwrite (const std::vector<std::string>& inputs, const std::vector<std::string>& outputs)
{
  for (std::size_t n = 0; n < outputs.size (); ++n)
  {
    if (outputs[n].empty ())
      continue;
    for (const std::string& input : inputs)
      if (!input.empty () && isSameFile (outputs[n], input))
        throw UsageError (outputs[n] + " would be overwritten: it is an input");
    for (std::size_t other = 0; other < n; ++other)
      if (!outputs[other].empty () && isSameFile (outputs[n], outputs[other]))
        throw UsageError (outputs[n] + " would be written twice");
  }
}

void
makeFolder (const fs::path& folder)
{
  std::error_code failure, ignored;
  fs::create_directories (folder, failure);
  if (!fs::is_directory (folder, ignored))
    throw IoError (folder.string () + ": the folder cannot be made" + (failure ? ": " + failure.message () : ""));
}

void
requireWritableFolder (const std::string& path, const std::string& folder_name)
{
  const fs::path folder (folder_name);
  std::error_code failure;
  if (!fs::is_directory (folder, failure))
    throw IoError (path + ": cannot be written, there is no folder " + folder.string ());
  try
  {
    tryToWriteIn (folder_name);
  }
  catch (const std::system_error& error)
  {
    throw IoError (path + ": cannot be written: " + error.code ().message ());
  }
}

void
requireWritable (const std::string& path)
{
  const fs::path target = followLinks (path);
  std::error_code failure;
  const fs::file_status status = fs::status (target, failure);
  if (status.type () == fs::file_type::none)
    throw IoError (path + ": cannot be written: " + failure.message ());
  if (fs::is_directory (status))
    throw IoError (path + ": cannot be written, it is a folder");
  if (fs::exists (status) && !fs::is_regular_file (status))
    throw IoError (path + ": cannot be written, it is not a regular file");
  if (fs::exists (status) && access (target.c_str (), W_OK) != 0)
    throw IoError (path + ": cannot be written: " + std::strerror (errno));
  const fs::path parent = target.parent_path ();
  requireWritableFolder (path, parent.empty () ? "." : parent.string ());
}

void
saveText (const std::string& text, const std::string& path)
{
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, text); });
}

void
saveJson (const nlohmann::ordered_json& json, const std::string& path)
{
  // File names need not be UTF-8.
  saveText (json.dump (2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n", path);
}

std::string
csvRow (const std::vector<std::string>& fields)
{
  std::string row;
  for (std::size_t n = 0; n < fields.size (); ++n)
  {
    row += n == 0 ? "" : ",";
    if (fields[n].find_first_of (",\"\r\n") == std::string::npos)
    {
      row += fields[n];
      continue;
    }
    row += '"';
    for (const char c : fields[n])
      row += c == '"' ? std::string ("\"\"") : std::string (1, c);
    row += '"';
  }
  return (row + "\n");
}
