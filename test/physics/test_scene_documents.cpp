// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/formats/scene_writers.h"

#include "common/temporary_folder.h"
#include "physics/scene_to_write.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

namespace pcl::cosection::test {
namespace {

using nlohmann::json;

/** \brief The two chunks of a GLB file, after checks of its frame (glTF 2.0, section 4). */
struct Glb
{
  explicit Glb (const std::string& bytes)
  {
    const auto word = [&] (std::size_t at) {
      std::uint32_t value;
      std::memcpy (&value, &bytes.at (at), sizeof (value));
      return value;
    };
    EXPECT_EQ (bytes.substr (0, 4), "glTF");
    EXPECT_EQ (word (4), 2u);
    EXPECT_EQ (word (8), bytes.size ());
    EXPECT_EQ (word (12) % 4, 0u);
    EXPECT_EQ (bytes.substr (16, 4), "JSON");
    document = json::parse (bytes.substr (20, word (12)));
    const std::size_t next = 20 + word (12);
    EXPECT_EQ (bytes.substr (next + 4, 4), std::string ("BIN\0", 4));
    EXPECT_EQ (next + 8 + word (next), bytes.size ());
    EXPECT_EQ (word (next) % 4, 0u);
    binary = bytes.substr (next + 8);
    EXPECT_GE (binary.size (), document["buffers"][0]["byteLength"]);
  }

  template <typename Value> std::vector<Value> values (const json& index) const
  {
    const json& accessor = document["accessors"].at (index.get<std::size_t> ());
    const json& view = document["bufferViews"].at (accessor["bufferView"].get<std::size_t> ());
    const std::size_t offset = view["byteOffset"], length = view["byteLength"];
    EXPECT_EQ (offset % 4, 0u);
    EXPECT_LE (offset + length, binary.size ());
    const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    std::vector<Value> result (accessor["count"].get<std::size_t> () * widths.at (accessor["type"]));
    EXPECT_EQ (result.size () * sizeof (Value), length);
    std::memcpy (result.data (), binary.data () + offset, length);
    return result;
  }

  /** \brief Nodes of a scene, below its root. */
  std::vector<json> nodesOf (std::size_t scene) const
  {
    std::vector<json> nodes;
    const json& root = document["nodes"].at (document["scenes"].at (scene)["nodes"].at (0).get<std::size_t> ());
    EXPECT_TRUE ((quaternionOf (root["rotation"]) * Eigen::Vector3d::UnitZ ()).isApprox (Eigen::Vector3d::UnitY ()));
    for (const json& child : root["children"])
      nodes.push_back (document["nodes"].at (child.get<std::size_t> ()));
    return nodes;
  }

  json document;
  std::string binary;
};

TEST (GltfWriter, accessorsMatchTheMeshes)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeGltf (scene, folder.file (""));
  const Glb glb (readFile (folder.file ("scene.glb")));
  for (const json& mesh : glb.document["meshes"])
    for (const json& primitive : mesh["primitives"])
    {
      const json& position = primitive["attributes"]["POSITION"];
      const std::vector<float> values = glb.values<float> (position);
      const auto points = Eigen::Map<const Eigen::Matrix3Xf> (values.data (), 3, Eigen::Index (values.size () / 3));
      const json& accessor = glb.document["accessors"][position.get<std::size_t> ()];
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_EQ (accessor["min"][axis].get<float> (), points.row (axis).minCoeff ());
        EXPECT_EQ (accessor["max"][axis].get<float> (), points.row (axis).maxCoeff ());
      }
      const std::vector<std::uint32_t> indices = glb.values<std::uint32_t> (primitive["indices"]);
      EXPECT_LT (*std::max_element (indices.begin (), indices.end ()), points.cols ());
    }
}

TEST (GltfWriter, nodesHavePosesColoursAndExtras)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeGltf (scene, folder.file (""));
  const Glb glb (readFile (folder.file ("scene.glb")));
  EXPECT_EQ (glb.document["scene"], 0);
  const std::vector<json> nodes = glb.nodesOf (0);
  ASSERT_EQ (nodes.size (), scene.planes.size () + scene.bodies.size ());
  const json& box = nodes[scene.planes.size ()];
  EXPECT_EQ (box["name"], "box_1");
  EXPECT_EQ (box["extras"]["mass_kg"], 0.24);
  EXPECT_EQ (box["translation"], json (asVector (scene.bodies[0].T_scene_body.translation ())));
  const json& primitive = glb.document["meshes"][box["mesh"].get<std::size_t> ()]["primitives"][0];
  const std::vector<std::uint8_t> colours = glb.values<std::uint8_t> (primitive["attributes"]["COLOR_0"]);
  EXPECT_EQ (colours[1], 255); // full light stays full
  EXPECT_EQ (colours[2], 32);  // 100 of sRGB, as light
  EXPECT_EQ (colours[3], 255);

  const std::vector<json> collision = glb.nodesOf (1);
  ASSERT_EQ (collision.size (), scene.bodies.size ());
  EXPECT_EQ (collision[0]["name"], "box_1_collision");
  EXPECT_EQ (glb.document["meshes"][collision[0]["mesh"].get<std::size_t> ()]["primitives"].size (), 2u);
}

TEST (GltfWriter, boxesOfPlanesAreClosedAndOutward)
{
  const TemporaryFolder folder;
  writeGltf (sceneToWrite (), folder.file (""));
  const Glb glb (readFile (folder.file ("scene.glb")));
  const json& primitive = glb.document["meshes"][glb.nodesOf (0)[0]["mesh"].get<std::size_t> ()]["primitives"][0];
  const std::vector<float> positions = glb.values<float> (primitive["attributes"]["POSITION"]);
  TriangleMesh mesh;
  for (std::size_t v = 0; v < positions.size (); v += 3)
    mesh.vertices.emplace_back (positions[v], positions[v + 1], positions[v + 2]);
  const std::vector<std::uint32_t> indices = glb.values<std::uint32_t> (primitive["indices"]);
  for (std::size_t t = 0; t < indices.size (); t += 3)
    mesh.triangles.push_back ({indices[t], indices[t + 1], indices[t + 2]});
  const MassProperties mass = computeMassProperties (mesh);
  EXPECT_NEAR (mass.volume_m3, 2.0 * 1.6 * 0.02, 1e-6);
  EXPECT_NEAR (mass.centroid_m.z (), -0.01, 1e-6); // the upper face is the plane
}

TEST (UsdWriter, principalAxesGiveTheInertia)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeUsd (scene, folder.file (""));
  const std::string text = readFile (folder.file ("scene.usda"));
  EXPECT_EQ (text.rfind ("#usda 1.0\n", 0), 0u);
  for (const auto& [left, right] : {std::pair ('{', '}'), std::pair ('(', ')'), std::pair ('[', ']')})
    EXPECT_EQ (std::count (text.begin (), text.end (), left), std::count (text.begin (), text.end (), right));
  const auto values = [&] (const std::string& property) {
    const std::size_t begin = text.find (property + " = ") + property.size () + 3;
    return numbersOf (text.substr (begin, text.find ('\n', begin) - begin));
  };
  const std::vector<double> moments = values ("physics:diagonalInertia"), wxyz = values ("physics:principalAxes");
  const Eigen::Matrix3d axes = Eigen::Quaterniond (wxyz[0], wxyz[1], wxyz[2], wxyz[3]).toRotationMatrix ();
  const Eigen::Matrix3d inertia = axes * Eigen::Vector3d (moments.data ()).asDiagonal () * axes.transpose ();
  EXPECT_TRUE (inertia.isApprox (scene.bodies[0].inertia, 1e-9));
  EXPECT_NEAR (values ("physics:gravityMagnitude")[0], scene.gravity.norm (), 1e-12);
}

TEST (PlanningSceneWriter, objectsHaveMeshesAndBoxes)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writePlanningScene (scene, folder.file (""));
  const json objects = json::parse (readFile (folder.file ("planning_scene.json")))["world"]["collision_objects"];
  ASSERT_EQ (objects.size (), scene.planes.size () + scene.bodies.size ());
  for (const json& object : objects)
  {
    EXPECT_EQ (object["header"]["frame_id"], scene.name);
    EXPECT_EQ (object["operation"], 0);
    EXPECT_EQ (object["meshes"].size (), object["mesh_poses"].size ());
    EXPECT_EQ (object["primitives"].size (), object["primitive_poses"].size ());
  }
  const json& shelf = objects[1];
  EXPECT_EQ (shelf["primitives"][0]["type"], 1);
  EXPECT_EQ (shelf["primitives"][0]["dimensions"], json ({2.0, 1.6, 0.02}));
  EXPECT_EQ (shelf["primitive_poses"][0]["position"]["z"], -0.01);
  const json& box = objects[2];
  EXPECT_EQ (box["id"], "box_1");
  ASSERT_EQ (box["meshes"].size (), 2u);
  EXPECT_EQ (box["meshes"][0]["vertices"].size (), 8u);
  EXPECT_EQ (box["meshes"][0]["vertices"][7]["x"].get<float> (), 0.01f);
  EXPECT_EQ (box["meshes"][0]["triangles"][0]["vertex_indices"], json ({0, 2, 1}));
}

} // namespace
} // namespace pcl::cosection::test
