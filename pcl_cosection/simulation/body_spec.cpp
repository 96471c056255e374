// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_spec.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/mesh_io.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double farthest_m = 1e6; // of a part, from the origin of its object
const TriangleMesh::Colour background_colour{190, 185, 175};
const TriangleMesh::Colour object_colours[] = {{205, 75, 60},  {60, 120, 190}, {80, 160, 95},
                                               {215, 170, 60}, {150, 95, 170}, {70, 165, 170}};

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

} // namespace

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

} // namespace pcl::cosection
