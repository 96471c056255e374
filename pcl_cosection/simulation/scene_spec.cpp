// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include "body_spec.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/json_depth.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace pcl::cosection {
namespace {

constexpr int largest_image = 8192;
constexpr int most_frames = 1000000;

double
radians (double degrees)
{
  return degrees * M_PI / 180.0;
}

void
parseCamera (SpecNode node, SimulatedScene& scene)
{
  node.requireObject ();
  PinholeCamera& camera = scene.camera;
  camera.width = node.whole ("width", 640, 1, largest_image);
  camera.height = node.whole ("height", 480, 1, largest_image);
  camera.fx = node.number ("fx", 525.0 * camera.width / 640.0);
  camera.fy = node.number ("fy", camera.fx);
  camera.cx = node.number ("cx", 0.5 * (camera.width - 1));
  camera.cy = node.number ("cy", 0.5 * (camera.height - 1));
  const std::pair<const char*, double> lengths[] = {{"fx", camera.fx}, {"fy", camera.fy}};
  for (const auto& [name, value] : lengths)
    if (!(value >= 1.0 && value <= 1e6))
      node.refuse (std::string ("has an impossible ") + name + ": a focal length must be from 1 to 1000000 pixels");
  if (!(camera.cx >= -camera.width && camera.cx <= 2 * camera.width && camera.cy >= -camera.height &&
        camera.cy <= 2 * camera.height))
    node.refuse ("has a principal point cx, cy far outside the image");
  scene.camera_motion = parseKeys (node.field ("keys"), true);
  node.finish ();
}

/** \brief It must look somewhere in every frame, not only at its keys. */
void
checkCamera (const SpecNode& keys, const SimulatedScene& scene)
{
  for (int frame = 0; frame < scene.frames; ++frame)
    try
    {
      scene.camera_motion.at (scene.timeOf (frame));
    }
    catch (const InvalidArgument& error)
    {
      keys.refuse ("are not right: at frame " + std::to_string (frame) + ", " + error.what ());
    }
}

DepthNoise
parseNoise (SpecNode node)
{
  node.requireObject ();
  DepthNoise noise;
  noise.baseline_m = node.number ("baseline", noise.baseline_m);
  noise.disparity_sigma_px = node.number ("disparity_sigma", noise.disparity_sigma_px);
  noise.disparity_step_px = node.number ("disparity_step", noise.disparity_step_px);
  noise.lateral_sigma_px = node.number ("lateral_sigma", noise.lateral_sigma_px);
  noise.grazing_begin_rad = radians (node.number ("grazing_begin_deg", noise.grazing_begin_rad * 180.0 / M_PI));
  noise.grazing_end_rad = radians (node.number ("grazing_end_deg", noise.grazing_end_rad * 180.0 / M_PI));
  noise.edge_dropout = node.number ("edge_dropout", noise.edge_dropout);
  noise.edge_step = node.number ("edge_step", noise.edge_step);
  noise.dropout = node.number ("dropout", noise.dropout);
  noise.shadows = node.flag ("shadows", noise.shadows);
  if (node.has ("range"))
  {
    const Eigen::Vector2d range = node.field ("range").vector<2> ();
    noise.min_m = range[0];
    noise.max_m = range[1];
  }
  node.finish ();
  try
  {
    noise.validate ();
  }
  catch (const InvalidArgument& error)
  {
    node.refuse ("is not right: " + std::string (error.what ()));
  }
  return noise;
}

void
parseDepth (SpecNode node, SimulatedScene& scene)
{
  node.requireObject ();
  if (node.has ("format"))
    scene.depth_format = node.field ("format").word ({"png", "exr"}) == "exr" ? DepthFormat::Exr : DepthFormat::Png;
  scene.depth_scale = node.number ("scale", scene.depth_scale);
  if (!(scene.depth_scale > 0.0 && scene.depth_scale <= 1e6))
    node.field ("scale").refuse ("must be a positive number of units per metre");
  scene.exact_depth = node.flag ("exact", scene.exact_depth);
  if (node.has ("noise"))
  {
    const SpecNode noise = node.field ("noise");
    if (noise.isFalse ())
      scene.noise.reset ();
    else if (!noise.isTrue ())
      scene.noise = parseNoise (noise);
  }
  node.finish ();
}

SimulatedScene
parseScene (SpecNode node, const std::string& folder)
{
  node.requireObject ();
  SimulatedScene scene;
  scene.noise.emplace ();
  for (const char* remark : {"name", "description"})
    if (node.has (remark))
      node.field (remark).text ();
  parseCamera (node.field ("camera"), scene);
  scene.frames = node.whole ("frames", 1, 1, most_frames);
  scene.rate = node.number ("rate", scene.rate);
  scene.seed = static_cast<std::uint64_t> (node.whole ("seed", 1, 0, 2147483647));
  if (node.has ("depth"))
    parseDepth (node.field ("depth"), scene);
  if (node.has ("views"))
  {
    SpecNode views = node.field ("views");
    views.requireObject ();
    scene.views_every = views.field ("every").whole (1, most_frames);
    views.finish ();
  }
  if (node.has ("background"))
    scene.bodies.push_back (parseBody (node.field ("background"), 0, folder));
  else
    scene.bodies.push_back ({"room", 0, {}, KeyedMotion (), 0.0});
  checkCamera (node.field ("camera").field ("keys"), scene);
  int number = 0;
  for (const SpecNode& object : node.field ("objects").elements ())
    scene.bodies.push_back (parseBody (object, ++number, folder));
  node.finish ();
  return scene;
}

/** \brief Let the names of mesh files begin at the root, so that the description may be read from anywhere. */
void
nameMeshFiles (nlohmann::ordered_json& node, const std::string& folder)
{
  for (auto& child : node)
    if (child.is_structured ())
      nameMeshFiles (child, folder);
  if (node.is_object () && node.contains ("file") && node["file"].is_string ())
  {
    const std::filesystem::path file (node["file"].get<std::string> ());
    if (file.is_relative ())
      node["file"] = std::filesystem::absolute (std::filesystem::path (folder) / file).lexically_normal ().string ();
  }
}

/** \brief A message without the control characters that texts of a description may have. */
std::string
inOneLine (std::string message)
{
  std::replace_if (
      message.begin (), message.end (), [] (unsigned char c) { return c < ' ' || c == 127; }, '?');
  return message;
}

/** \throws InvalidArgument if it is not well-formed, or an object has a field twice */
nlohmann::ordered_json
parseJson (const std::string& text)
{
  if (nestsDeeply (text))
    throw InvalidArgument ("is not well-formed JSON of a scene: it has too many brackets within each other");
  std::vector<std::set<std::string>> fields; // of the objects that are being read
  const auto watch = [&] (int, nlohmann::ordered_json::parse_event_t event, nlohmann::ordered_json& value) {
    using Event = nlohmann::ordered_json::parse_event_t;
    if (event == Event::object_start)
      fields.emplace_back ();
    else if (event == Event::object_end)
      fields.pop_back ();
    else if (event == Event::key && !fields.back ().insert (value.get<std::string> ()).second)
      throw InvalidArgument ("has the field \"" + value.get<std::string> () + "\" twice in one object");
    return true;
  };
  try
  {
    return nlohmann::ordered_json::parse (text, watch, true, true);
  }
  catch (const nlohmann::json::exception& error)
  {
    std::string why = error.what ();
    if (why.find ("] ") != std::string::npos)
      why = why.substr (why.find ("] ") + 2);
    throw InvalidArgument ("is not well-formed JSON: " + why);
  }
}

} // namespace

std::string
effectiveSpec (const SimulatedScene& scene)
{
  if (scene.spec.empty ())
    return "";
  nlohmann::ordered_json json = nlohmann::ordered_json::parse (scene.spec);
  json["seed"] = scene.seed;
  if (!scene.noise)
    json["depth"]["noise"] = false;
  if (scene.views_every > 0)
    json["views"]["every"] = scene.views_every;
  else
    json.erase ("views");
  return json.dump (2) + "\n";
}

SimulatedScene
parseSceneSpec (const std::string& text, const std::string& name, const std::string& folder)
{
  try
  {
    nlohmann::ordered_json json = parseJson (text);
    SimulatedScene scene = parseScene (SpecNode (json, name + ": "), folder);
    scene.validate ();
    nameMeshFiles (json, folder);
    scene.spec = json.dump (2) + "\n";
    return scene;
  }
  catch (const InvalidArgument& error)
  {
    const std::string what = error.what ();
    throw InvalidArgument (inOneLine (what.rfind (name + ": ", 0) == 0 ? what : name + ": " + what));
  }
  catch (const IoError& error) // of a mesh
  {
    throw IoError (inOneLine (error.what ()));
  }
}

SimulatedScene
loadSceneSpec (const std::string& path)
{
  return parseSceneSpec (readBytes (path), path, std::filesystem::path (path).parent_path ().string ());
}

} // namespace pcl::cosection
