// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_summary.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

constexpr int largest_image = 8192;
constexpr double shortest_normal = 1e-6; ///< of a plane that is one

double
numberOf (const Json& json, const char* name)
{
  const Json& field = fieldOf (json, name);
  return field.is_number () ? field.get<double> () : 0.0;
}

} // namespace

const Json&
fieldOf (const Json& json, const char* name)
{
  static const Json none;
  const auto field = json.find (name);
  return field != json.end () ? *field : none;
}

std::string
textOf (const Json& json, const char* name)
{
  const Json& field = fieldOf (json, name);
  return field.is_string () ? field.get<std::string> () : std::string ();
}

std::vector<double>
numbersOf (const Json& json, const char* name, std::size_t count)
{
  const Json& field = fieldOf (json, name);
  const bool fits = field.is_array () && field.size () == count &&
                    std::all_of (field.begin (), field.end (), [] (const Json& value) { return value.is_number (); });
  return fits ? field.get<std::vector<double>> () : std::vector<double> ();
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
  if (const std::vector<double> k = numbersOf (json, "intrinsics", 4); !k.empty ())
    source.intrinsics = {k[0], k[1], k[2], k[3]};
  return source;
}

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

std::optional<Eigen::Vector3d>
firstNormalOf (const Json& planes)
{
  if (!planes.is_array () || planes.empty ())
    return std::nullopt;
  const std::vector<double> plane = numbersOf ({{"plane", planes.front ()}}, "plane", 4);
  if (plane.empty ())
    return std::nullopt;
  const Eigen::Vector3d normal (plane.data ());
  const bool is_one = normal.norm () > shortest_normal && std::isfinite (normal.norm ());
  return is_one ? std::optional (normal.normalized ()) : std::nullopt;
}

} // namespace pcl::cosection
