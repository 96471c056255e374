// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "views_command.h"

#include "output_files.h"
#include "terminal.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace fs = std::filesystem;

using namespace pcl::cosection;

namespace {

std::vector<fs::path>
sortedEntries (const std::string& folder)
{
  std::vector<fs::path> entries;
  try
  {
    for (const auto& entry : fs::directory_iterator (folder))
      entries.push_back (entry.path ());
  }
  catch (const fs::filesystem_error& error)
  {
    throw IoError (folder + ": cannot be read: " + error.code ().message ());
  }
  std::sort (entries.begin (), entries.end ());
  return (entries);
}

/** \brief What is behind \a label in the line of names.txt that begins with it; else nothing. */
std::string
nameIn (const fs::path& scene, const std::string& label)
{
  const fs::path path = scene / "names.txt";
  std::istringstream file (fs::exists (path) ? readBytes (path.string ()) : "");
  for (std::string number, name; file >> number && std::getline (file >> std::ws, name);)
    if (number == label)
      return (name);
  return ("");
}

/** \brief The mesh of an object, of any of the formats of pcl_cosection; the PLY if there is none. */
std::string
resultFile (const fs::path& scene, const std::string& label)
{
  for (const char* extension : {".ply", ".stl", ".obj"})
    if (const fs::path file = scene / ("object_" + label + extension); fs::exists (file))
      return (file.string ());
  return ((scene / ("object_" + label + ".ply")).string ());
}

} // namespace

std::vector<ViewedFiles>
findViewedFiles (const std::string& truth, const std::string& result)
{
  sortedEntries (result); // throws if it is no folder
  const std::string prefix = "truth_";
  std::vector<ViewedFiles> objects;
  for (const fs::path& scene : sortedEntries (truth))
  {
    if (!fs::is_directory (scene))
      continue;
    for (const fs::path& file : sortedEntries (scene.string ()))
    {
      const std::string stem = file.stem ().string ();
      if (stem.compare (0, prefix.size (), prefix) != 0 || !endsWith (file.string (), ".ply"))
        continue;
      const std::size_t end = stem.find ('_', prefix.size ());
      ViewedFiles object;
      object.scene = scene.filename ().string ();
      object.label = stem.substr (prefix.size (), end == stem.npos ? stem.npos : end - prefix.size ());
      object.name = end == stem.npos ? nameIn (scene, object.label) : stem.substr (end + 1);
      object.truth = file.string ();
      object.result = resultFile (fs::path (result) / object.scene, object.label);
      objects.push_back (object);
    }
  }
  if (objects.empty ())
    throw IoError (truth + ": has no SCENE/truth_LABEL.ply");
  if (std::none_of (objects.begin (), objects.end (),
                    [] (const ViewedFiles& object) { return (fs::exists (object.result)); }))
    throw IoError (result + ": has none of the " + counted (objects.size (), "object") + " of " + truth +
                   "; the first would be " + objects.front ().result);
  return (objects);
}
