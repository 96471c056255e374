// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include "spec_node.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/json_depth.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

namespace pcl::cosection {
namespace {

constexpr int largest_image = 8192;
constexpr int most_frames = 1000000;
constexpr double farthest_m = 1e6; // of a part, from the origin of its object
const TriangleMesh::Colour background_colour{190, 185, 175};
const TriangleMesh::Colour object_colours[] = {{205, 75, 60},  {60, 120, 190}, {80, 160, 95},
                                               {215, 170, 60}, {150, 95, 170}, {70, 165, 170}};

double
radians (double degrees)
{
  return degrees * M_PI / 180.0;
}

/** \brief A rotation from the fields rpy_deg or quaternion; the identity without either. */
Eigen::Quaterniond
parseRotation (SpecNode& node)
{
  const bool has_angles = node.has ("rpy_deg"), has_quaternion = node.has ("quaternion");
  if (has_angles && has_quaternion)
    node.refuse ("has both rpy_deg and quaternion");
  if (has_quaternion)
  {
    const Eigen::Vector4d q = node.field ("quaternion").vector<4> ();
    if (!(std::abs (q.norm () - 1.0) < 0.01))
      node.field ("quaternion").refuse ("must have the length 1; it is x, y, z, w");
    return Eigen::Quaterniond (q[3], q[0], q[1], q[2]).normalized ();
  }
  if (!has_angles)
    return Eigen::Quaterniond::Identity ();
  const Eigen::Vector3d a = node.field ("rpy_deg").vector<3> () * M_PI / 180.0;
  return Eigen::AngleAxisd (a[2], Eigen::Vector3d::UnitZ ()) * Eigen::AngleAxisd (a[1], Eigen::Vector3d::UnitY ()) *
         Eigen::AngleAxisd (a[0], Eigen::Vector3d::UnitX ());
}

/** \brief The keys of a motion; those of a camera may look at something. */
KeyedMotion
parseKeys (const SpecNode& list, bool is_camera)
{
  std::vector<double> times;
  std::vector<Eigen::Vector3d> positions, targets;
  std::vector<Eigen::Quaterniond> rotations;
  std::optional<Eigen::Vector3d> up;
  for (SpecNode key : list.elements (1))
  {
    key.requireObject ();
    times.push_back (key.number ("time", 0.0));
    positions.push_back (key.field ("position").vector<3> ());
    if (is_camera && key.has ("look_at"))
    {
      targets.push_back (key.field ("look_at").vector<3> ());
      if (key.has ("up"))
      {
        const Eigen::Vector3d given = key.field ("up").vector<3> ();
        if (up && *up != given)
          key.field ("up").refuse ("must be the same in all keys");
        up = given;
      }
      if (key.has ("rpy_deg") || key.has ("quaternion"))
        key.refuse ("has both look_at and a rotation");
    }
    else
      rotations.push_back (parseRotation (key));
    key.finish ();
  }
  if (!targets.empty () && !rotations.empty ())
    list.refuse ("must either all have look_at, or none");
  try
  {
    KeyedVector position (times, positions);
    KeyedMotion motion = targets.empty () ? KeyedMotion (position, KeyedRotation (times, rotations))
                                          : KeyedMotion (position, KeyedVector (times, targets),
                                                         up.value_or (Eigen::Vector3d::UnitZ ()));
    for (const double time : times)
      motion.at (time); // looks somewhere
    return motion;
  }
  catch (const InvalidArgument& error)
  {
    list.refuse ("are not right: " + std::string (error.what ()));
  }
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

Polygon2d
parsePolygon (const SpecNode& node)
{
  Polygon2d polygon;
  for (const SpecNode& point : node.elements (3))
    polygon.push_back (point.vector<2> ());
  return polygon;
}

/** \param[out] mesh_file if the shape comes from one */
Shape::ConstPtr
parseShape (SpecNode& node, const std::string& folder, std::string& mesh_file)
{
  const std::string type = node.field ("type").word (
      {"sphere", "box", "room", "cylinder", "cone", "capsule", "torus", "revolution", "extrusion", "plane", "mesh"});
  const auto length = [&node] (const char* name) { return node.field (name).number (); };
  if (type == "sphere")
    return makeSphere (length ("radius"));
  if (type == "box")
    return makeBox (node.field ("size").vector<3> (), node.number ("rounding", 0.0));
  if (type == "room")
    return makeRoom (node.field ("size").vector<3> ());
  if (type == "cylinder")
    return makeCylinder (length ("radius"), length ("height"));
  if (type == "cone")
    return makeCone (length ("bottom_radius"), length ("top_radius"), length ("height"));
  if (type == "capsule")
    return makeCapsule (length ("radius"), length ("length"));
  if (type == "torus")
    return makeTorus (length ("radius"), length ("tube_radius"));
  if (type == "revolution")
    return makeRevolution (parsePolygon (node.field ("profile")));
  if (type == "extrusion")
    return makeExtrusion (parsePolygon (node.field ("outline")), length ("height"));
  if (type == "plane")
    return makeHalfSpace (node.number ("extent", 20.0));
  const std::filesystem::path file (node.field ("file").text ());
  const double scale = node.number ("scale", 1.0);
  mesh_file = (file.is_absolute () ? file : std::filesystem::path (folder) / file).string ();
  return makeMeshShape (loadMesh (mesh_file), scale);
}

TriangleMesh::Colour
parseColour (SpecNode& node, const TriangleMesh::Colour& otherwise)
{
  if (!node.has ("colour"))
    return otherwise;
  TriangleMesh::Colour colour;
  const std::vector<SpecNode> numbers = node.field ("colour").elements ();
  if (numbers.size () != colour.size ())
    node.field ("colour").refuse ("must be 3 numbers: red, green, blue");
  for (std::size_t n = 0; n < colour.size (); ++n)
    colour[n] = static_cast<std::uint8_t> (numbers[n].whole (0, 255));
  return colour;
}

BodyPart
parsePart (SpecNode node, const TriangleMesh::Colour& colour, const std::string& folder)
{
  node.requireObject ();
  BodyPart part;
  part.colour = parseColour (node, colour);
  if (node.has ("position"))
  {
    part.T_body_part.translation () = node.field ("position").vector<3> ();
    if (part.T_body_part.translation ().cwiseAbs ().maxCoeff () > farthest_m)
      node.field ("position").refuse ("must be within a million metres");
  }
  part.T_body_part.linear () = parseRotation (node).toRotationMatrix ();
  try
  {
    part.shape = parseShape (node, folder, part.file);
  }
  catch (const InvalidArgument& error)
  {
    const std::string what = error.what ();
    if (what.rfind (node.path (), 0) == 0)
      throw;
    node.refuse ("is not right: " + what); // from the shape itself
  }
  node.finish ();
  return part;
}

SceneBody
parseBody (SpecNode node, int number, const std::string& folder)
{
  node.requireObject ();
  SceneBody body;
  body.id = number == 0 ? 0 : node.whole ("id", number, 1, ignored_label - 1);
  body.name = node.has ("name") ? node.field ("name").text ()
              : number == 0     ? "room"
                                : "object_" + std::to_string (body.id);
  body.pattern_size_m = node.number ("pattern_size", 0.0);
  const TriangleMesh::Colour colour = parseColour (
      node, number == 0 ? background_colour : object_colours[(number - 1) % std::size (object_colours)]);
  if (number > 0 && node.has ("shape"))
    body.parts.push_back (parsePart (node.field ("shape"), colour, folder));
  else
    for (const SpecNode& part : node.field ("parts").elements (number == 0 ? 0 : 1))
      body.parts.push_back (parsePart (part, colour, folder));
  if (number > 0)
    body.motion = parseKeys (node.field ("keys"), false);
  node.finish ();
  return body;
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
