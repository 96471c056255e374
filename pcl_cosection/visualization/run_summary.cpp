// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_summary.h"

#include <pcl/cosection/common/error.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

constexpr int largest_image = 8192;

/** \brief A field of an object; null if there is none. */
const Json&
fieldOf (const Json& json, const char* name)
{
  static const Json none;
  const auto field = json.is_object () ? json.find (name) : json.end ();
  return json.is_object () && field != json.end () ? *field : none;
}

std::string
textOf (const Json& json, const char* name)
{
  const Json& field = fieldOf (json, name);
  return field.is_string () ? field.get<std::string> () : std::string ();
}

double
numberOf (const Json& json, const char* name)
{
  const Json& field = fieldOf (json, name);
  return field.is_number () ? field.get<double> () : 0.0;
}

std::optional<PinholeCamera>
cameraOf (const Json& json)
{
  const double width = numberOf (json, "width"), height = numberOf (json, "height");
  if (!(width >= 1.0 && width <= largest_image && height >= 1.0 && height <= largest_image))
    return std::nullopt;
  const PinholeCamera camera = {static_cast<int> (width), static_cast<int> (height), numberOf (json, "fx"),
                                numberOf (json, "fy"),    numberOf (json, "cx"),     numberOf (json, "cy")};
  try
  {
    camera.validate ();
    return camera;
  }
  catch (const InvalidArgument&)
  {
    return std::nullopt;
  }
}

SequenceSource
sourceOf (const Json& json)
{
  SequenceSource source;
  const std::string format = textOf (json, "format");
  source.format = format == "cofusion"  ? SequenceFormat::CoFusion
                  : format == "tum"     ? SequenceFormat::Tum
                  : format == "7scenes" ? SequenceFormat::SevenScenes
                                        : SequenceFormat::Detect;
  source.depth_folder = textOf (json, "depth_dir");
  source.depth_scale = std::max (0.0, numberOf (json, "depth_scale"));
  const Json& intrinsics = fieldOf (json, "intrinsics");
  if (intrinsics.is_array () && intrinsics.size () == 4 &&
      std::all_of (intrinsics.begin (), intrinsics.end (), [] (const Json& value) { return value.is_number (); }))
    source.intrinsics = intrinsics.get<std::array<double, 4>> ();
  return source;
}

/** \brief By object; classes that have a number only have no name. */
std::map<int, std::string>
classesOf (const Json& objects)
{
  std::map<int, std::string> classes;
  if (!objects.is_array ())
    return classes;
  for (const Json& object : objects)
  {
    const Json& id = fieldOf (object, "id");
    const std::string name = textOf (object, "class");
    if (id.is_number_integer () && name.find_first_not_of ("0123456789") != std::string::npos)
      classes[id.get<int> ()] = name;
  }
  return classes;
}

} // namespace

RunSummary
readRunSummary (const std::string& folder, ReadingNotes& notes)
{
  RunSummary summary;
  const std::string path = (fs::path (folder) / "summary.json").string ();
  std::ifstream file (path);
  if (!file)
    return summary;
  summary.is_there = true;
  const Json json = Json::parse (file, nullptr, false);
  if (!json.is_object ())
  {
    notes.warnings.push_back (path + ": is no JSON object");
    notes.whole = false;
    return summary;
  }
  summary.error = textOf (json, "error");
  summary.camera = cameraOf (fieldOf (json, "camera"));
  summary.classes = classesOf (fieldOf (json, "objects"));
  const Json& parameters = fieldOf (json, "parameters");
  summary.dataset = textOf (parameters, "dataset");
  summary.source = sourceOf (fieldOf (parameters, "images"));
  return summary;
}

} // namespace pcl::cosection
