// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_folder.h"
#include "scene_geometry.h"
#include "scene_json.h"
#include "scene_writers.h"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace pcl::cosection {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification of glTF 2.0, section 5.
constexpr int unsigned_byte = 5121;
constexpr int unsigned_int = 5125;
constexpr int real = 5126;
constexpr int vertex_buffer = 34962;
constexpr int index_buffer = 34963;
constexpr std::size_t alignment = 4; ///< of the chunks and of all numbers

/** \brief Collects the JSON and the binary part of a file. */
class GltfDocument
{
public:
  explicit GltfDocument (const std::string& generator)
  {
    json_["asset"] = {{"version", "2.0"}, {"generator", generator}};
  }

  /** \brief \return its index; an element of the array \a kind */
  std::size_t add (const char* kind, Json element)
  {
    json_[kind].push_back (std::move (element));
    return json_[kind].size () - 1;
  }

  std::size_t addMaterial (const std::string& name, const Eigen::Vector3f& colour);

  /** \brief A mesh of which each element is a primitive. All have triangles. */
  std::size_t addMesh (const std::string& name, const std::vector<const TriangleMesh*>& primitives,
                       std::size_t material);

  /** \brief A scene whose root turns the z axis, which is up, into the y axis. */
  void addScene (const std::string& name, const Json& nodes);

  std::string encode ();

private:
  Json primitive (const TriangleMesh& mesh, std::size_t material);

  /** \brief \return the index of the accessor of an array of numbers, whose size must be a multiple of four bytes */
  template <typename Element>
  std::size_t addAccessor (const std::vector<Element>& values, const char* type, int component, int buffer,
                           const Json& more);

  Json json_;
  std::string binary_;
};

std::size_t
GltfDocument::addMaterial (const std::string& name, const Eigen::Vector3f& colour)
{
  constexpr double rough = 0.9;
  return add ("materials", {{"name", name},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {colour.x (), colour.y (), colour.z (), 1.0}},
                              {"metallicFactor", 0.0},
                              {"roughnessFactor", rough}}},
                            {"doubleSided", true}}); // static surfaces may be open
}

template <typename Element>
std::size_t
GltfDocument::addAccessor (const std::vector<Element>& values, const char* type, int component, int buffer,
                           const Json& more)
{
  static_assert (sizeof (Element) % alignment == 0);
  const std::size_t bytes = values.size () * sizeof (Element);
  const std::size_t view = add (
      "bufferViews", {{"buffer", 0}, {"byteOffset", binary_.size ()}, {"byteLength", bytes}, {"target", buffer}});
  binary_.append (reinterpret_cast<const char*> (values.data ()), bytes);
  Json accessor = {{"bufferView", view}, {"componentType", component}, {"type", type}};
  accessor.update (more);
  return add ("accessors", std::move (accessor));
}

Json
GltfDocument::primitive (const TriangleMesh& mesh, std::size_t material)
{
  const Eigen::AlignedBox3f bounds = boundsOf (mesh);
  const std::size_t count = mesh.vertices.size ();
  Json attributes;
  attributes["POSITION"] = addAccessor (
      mesh.vertices, "VEC3", real, vertex_buffer,
      {{"count", count}, {"min", toJson (bounds.min ())}, {"max", toJson (bounds.max ())}});
  if (!mesh.normals.empty ())
  {
    std::vector<Eigen::Vector3f> normals = mesh.normals;
    for (Eigen::Vector3f& normal : normals) // the format forbids any other length
      normal = normal.squaredNorm () > 0.0f ? normal.normalized () : Eigen::Vector3f (Eigen::Vector3f::UnitZ ());
    attributes["NORMAL"] = addAccessor (normals, "VEC3", real, vertex_buffer, {{"count", count}});
  }
  if (!mesh.colours.empty ())
  {
    std::vector<std::array<std::uint8_t, 4>> colours;
    colours.reserve (count);
    for (const TriangleMesh::Colour& colour : mesh.colours)
    {
      const auto c = (255.0f * linearColour (colour)).array ().round ().cast<std::uint8_t> ().eval ();
      colours.push_back ({c[0], c[1], c[2], 255});
    }
    attributes["COLOR_0"] = addAccessor (colours, "VEC4", unsigned_byte, vertex_buffer,
                                         {{"count", count}, {"normalized", true}});
  }
  const std::size_t indices = addAccessor (mesh.triangles, "SCALAR", unsigned_int, index_buffer,
                                           {{"count", 3 * mesh.triangles.size ()}});
  return {{"attributes", std::move (attributes)}, {"indices", indices}, {"material", material}};
}

std::size_t
GltfDocument::addMesh (const std::string& name, const std::vector<const TriangleMesh*>& primitives,
                       std::size_t material)
{
  Json json = {{"name", name}, {"primitives", Json::array ()}};
  for (const TriangleMesh* mesh : primitives)
    json["primitives"].push_back (primitive (*mesh, material));
  return add ("meshes", std::move (json));
}

void
GltfDocument::addScene (const std::string& name, const Json& nodes)
{
  const double half = std::sqrt (0.5);
  Json root = {{"name", name}, {"rotation", {-half, 0.0, 0.0, half}}};
  if (!nodes.empty ())
    root["children"] = nodes;
  add ("scenes", {{"name", name}, {"nodes", {add ("nodes", std::move (root))}}});
}

void
appendWord (std::string& bytes, std::uint32_t word)
{
  bytes.append (reinterpret_cast<const char*> (&word), sizeof (word));
}

void
appendChunk (std::string& bytes, const char* kind, std::string chunk, char padding)
{
  chunk.resize ((chunk.size () + alignment - 1) / alignment * alignment, padding);
  appendWord (bytes, static_cast<std::uint32_t> (chunk.size ()));
  bytes.append (kind, alignment);
  bytes += chunk;
}

std::string
GltfDocument::encode ()
{
  if (!binary_.empty ())
    add ("buffers", {{"byteLength", binary_.size ()}});
  json_["scene"] = 0;
  std::string chunks;
  appendChunk (chunks, "JSON", jsonText (json_, -1), ' ');
  if (!binary_.empty ())
    appendChunk (chunks, "BIN\0", binary_, '\0');
  constexpr std::uint32_t header_size = 12, version = 2;
  std::string bytes = "glTF";
  appendWord (bytes, version);
  appendWord (bytes, header_size + static_cast<std::uint32_t> (chunks.size ()));
  return bytes + chunks;
}

/** \brief A node with a pose. */
Json
nodeAt (const std::string& name, const Eigen::Isometry3d& pose)
{
  return {{"name", name},
          {"translation", toJson (pose.translation ())},
          {"rotation", toJson (rotationOf (pose).coeffs ())}};
}

std::size_t
addBody (GltfDocument& document, const PhysicalBody& body)
{
  Json node = nodeAt (body.name, body.T_scene_body);
  if (!body.visual.empty ())
  {
    // Colours of vertices are multiplied by that of the material.
    const Eigen::Vector3f colour = body.visual.colours.empty () ? linearColour (body.colour)
                                                                : Eigen::Vector3f (Eigen::Vector3f::Ones ());
    node["mesh"] = document.addMesh (body.name, {&body.visual}, document.addMaterial (body.name, colour));
  }
  node["extras"] = {{"id", body.id},
                    {"static", body.isStatic ()},
                    {"mass_kg", body.mass_kg},
                    {"centre_m", toJson (body.centre_m)},
                    {"inertia", toJson (body.inertia)},
                    {"volume_m3", body.volume_m3}};
  return document.add ("nodes", std::move (node));
}

/** \brief The box of a plane, with normals: each corner is there three times. */
TriangleMesh
planeMesh (const PhysicalPlane& plane)
{
  TriangleMesh mesh;
  const Eigen::Vector3d centre = boxCentre (plane), half = 0.5 * boxSize (plane);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
    {
      const auto first = static_cast<std::uint32_t> (mesh.vertices.size ());
      const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit (axis);
      const Eigen::Vector3d u = Eigen::Vector3d::Unit ((axis + 1) % 3), v = normal.cross (u);
      for (const auto& [s, t] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      {
        mesh.vertices.push_back ((centre + half.cwiseProduct (normal + s * u + t * v)).cast<float> ());
        mesh.normals.push_back (normal.cast<float> ());
      }
      mesh.triangles.push_back ({first, first + 1, first + 2});
      mesh.triangles.push_back ({first, first + 2, first + 3});
    }
  return mesh;
}

std::string
encodeScene (const PhysicalScene& scene)
{
  GltfDocument document ("pcl_cosection");
  Json shown = Json::array (), colliding = Json::array ();
  for (const PhysicalPlane& plane : scene.planes)
  {
    const TriangleMesh mesh = planeMesh (plane);
    Json node = nodeAt (plane.name, plane.T_scene_plane);
    node["mesh"] = document.addMesh (plane.name, {&mesh},
                                     document.addMaterial (plane.name, linearColour (plane_colour)));
    node["extras"] = {{"static", true}, {"endless", plane.endless}};
    shown.push_back (document.add ("nodes", std::move (node)));
  }
  for (const PhysicalBody& body : scene.bodies)
    shown.push_back (addBody (document, body));
  for (const PhysicalBody& body : scene.bodies)
  {
    if (body.parts.empty ())
      continue;
    std::vector<const TriangleMesh*> parts;
    for (const TriangleMesh& part : body.parts)
      parts.push_back (&part);
    const std::string name = body.name + "_collision";
    Json node = nodeAt (name, body.T_scene_body);
    node["mesh"] = document.addMesh (name, parts, document.addMaterial (name, linearColour (body.colour)));
    node["extras"] = {{"id", body.id}, {"convex", body.convex}};
    colliding.push_back (document.add ("nodes", std::move (node)));
  }
  document.addScene (scene.name, shown);
  if (!colliding.empty ())
    document.addScene (scene.name + "_collision", colliding);
  return document.encode ();
}

} // namespace

std::vector<std::string>
writeGltf (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  addSceneJson (scene, files);
  files.write ("scene.glb", encodeScene (scene));
  return files.finish ();
}

} // namespace pcl::cosection
