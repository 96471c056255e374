// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/formats/scene_writers.h"

#include "common/small_meshes.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <locale>
#include <map>
#include <sstream>

namespace pcl::cosection::test {
namespace {

using nlohmann::json;
using SceneWriter = std::vector<std::string> (*) (const PhysicalScene&, const std::string&);
using Element = vtkXMLDataElement;

/** \brief A box of two parts, a ball, a flat static surface, an endless plane and a tilted one with an end. */
PhysicalScene
sceneToWrite ()
{
  PhysicalScene scene;
  scene.name = "a <scene> & \"more\"";
  scene.T_result_scene = Eigen::Translation3d (1.0, 2.0, 3.0) * Eigen::AngleAxisd (0.3, Eigen::Vector3d::UnitX ());
  scene.gravity = {0.1, 0.0, -9.7};
  scene.warnings = {"not UTF-8: \xff"};

  PhysicalBody box;
  box.name = "box_1";
  box.id = 1;
  box.T_scene_body = Eigen::Translation3d (0.3, -0.2, 0.03) * Eigen::AngleAxisd (0.7, Eigen::Vector3d::UnitZ ());
  box.visual = boxMesh ({-0.05f, -0.04f, -0.03f}, {0.05f, 0.04f, 0.03f});
  for (std::uint8_t v = 0; v < 8; ++v)
    box.visual.colours.push_back ({std::uint8_t (30 * v), std::uint8_t (255 - 20 * v), 100});
  box.parts = {boxMesh ({-0.05f, -0.04f, -0.03f}, {0.01f, 0.04f, 0.03f}),
               boxMesh ({0.01f, -0.04f, -0.03f}, {0.05f, 0.04f, 0.03f})};
  box.mass_kg = 0.24;
  box.centre_m = {0.001, 0.002, -1.0 / 300.0};
  box.inertia << 2e-4, 1e-5, 2e-6, 1e-5, 2.7e-4, -3e-6, 2e-6, -3e-6, 3.3e-4;
  box.stands_on = 0;

  PhysicalBody ball;
  ball.name = "ball_2";
  ball.id = 2;
  ball.T_scene_body.translation () << -0.3, 0.0, 0.04;
  ball.visual = sphereMesh (0.04, 12);
  ball.parts = {sphereMesh (0.04, 6)};
  ball.mass_kg = 0.2;
  ball.inertia = 1.28e-4 * Eigen::Matrix3d::Identity ();

  PhysicalBody wall;
  wall.name = "wall";
  wall.visual = sheetMesh (3, [] (double, double) { return true; });
  wall.parts = {boxMesh ({0.0f, 0.0f, -0.1f}, {1.0f, 1.0f, 0.0f})};
  wall.convex = false;
  scene.bodies = {box, ball, wall};

  PhysicalPlane table;
  table.name = "table";
  table.half_size_m = {1.0, 0.8};
  PhysicalPlane shelf = table;
  shelf.name = "shelf";
  shelf.T_scene_plane = Eigen::Translation3d (2.0, 0.0, 0.5) * Eigen::AngleAxisd (0.2, Eigen::Vector3d::UnitX ());
  shelf.endless = false;
  scene.planes = {table, shelf};
  return scene;
}

/** \brief Contents of all files below a folder, hidden ones too, by their paths from there. */
std::map<std::string, std::string>
filesBelow (const std::string& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator (folder))
    if (entry.is_regular_file ())
      files[std::filesystem::relative (entry.path (), folder).string ()] = readFile (entry.path ().string ());
  return files;
}

vtkSmartPointer<Element>
parseXml (const std::string& path)
{
  return vtkSmartPointer<Element>::Take (vtkXMLUtilities::ReadElementFromFile (path.c_str ()));
}

/** \brief All elements of a name, at any depth, in their order. */
std::vector<Element*>
elementsOf (Element* root, const std::string& name)
{
  std::vector<Element*> found;
  for (int n = 0; n < root->GetNumberOfNestedElements (); ++n)
  {
    Element* child = root->GetNestedElement (n);
    if (name == child->GetName ())
      found.push_back (child);
    const std::vector<Element*> below = elementsOf (child, name);
    found.insert (found.end (), below.begin (), below.end ());
  }
  return found;
}

std::vector<double>
numbersOf (std::string text)
{
  std::replace_if (
      text.begin (), text.end (), [] (char c) { return std::strchr ("(),", c) != nullptr; }, ' ');
  std::istringstream in (text);
  in.imbue (std::locale::classic ());
  std::vector<double> numbers;
  for (double number; in >> number;)
    numbers.push_back (number);
  return numbers;
}

std::vector<double>
attributeOf (Element* element, const char* name)
{
  return numbersOf (element->GetAttribute (name));
}

std::vector<double>
asVector (const Eigen::Ref<const Eigen::VectorXd>& values)
{
  return {values.data (), values.data () + values.size ()};
}

Eigen::Quaterniond
quaternionOf (const std::vector<double>& xyzw)
{
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

struct NamedWriter
{
  const char* name;
  SceneWriter write;
  const char* main_file;
};

std::ostream&
operator<< (std::ostream& out, const NamedWriter& writer)
{
  return out << writer.name;
}

class SceneWriters : public ::testing::TestWithParam<NamedWriter>
{};

INSTANTIATE_TEST_SUITE_P (Formats, SceneWriters,
                          ::testing::Values (NamedWriter{"urdf", writeUrdf, "scene.json"},
                                             NamedWriter{"sdf", writeSdf, "scene.sdf"},
                                             NamedWriter{"mjcf", writeMjcf, "scene.xml"},
                                             NamedWriter{"gltf", writeGltf, "scene.glb"},
                                             NamedWriter{"usd", writeUsd, "scene.usda"},
                                             NamedWriter{"planning", writePlanningScene, "planning_scene.json"},
                                             NamedWriter{"json", writeSceneJson, "scene.json"}),
                          [] (const auto& writer) { return std::string (writer.param.name); });

TEST_P (SceneWriters, listsEveryFileAndTheMainOneLast)
{
  const TemporaryFolder folder;
  const std::vector<std::string> listed = GetParam ().write (sceneToWrite (), folder.file (""));
  std::map<std::string, std::string> files = filesBelow (folder.file (""));
  EXPECT_EQ (files.count ("scene.json"), 1u);
  EXPECT_EQ (listed.size (), files.size ());
  for (const std::string& path : listed)
  {
    EXPECT_GT (std::filesystem::file_size (path), 0u) << path;
    files.erase (std::filesystem::relative (path, folder.file ("")).string ());
  }
  EXPECT_TRUE (files.empty ()) << files.begin ()->first;
  EXPECT_EQ (std::filesystem::path (listed.back ()).filename (), GetParam ().main_file);
}

TEST_P (SceneWriters, writesTheSameBytesAgain)
{
  const TemporaryFolder first, second;
  GetParam ().write (sceneToWrite (), first.file (""));
  GetParam ().write (sceneToWrite (), second.file (""));
  GetParam ().write (sceneToWrite (), second.file ("")); // over what is there
  EXPECT_EQ (filesBelow (first.file ("")), filesBelow (second.file ("")));
}

TEST_P (SceneWriters, doesNotDependOnTheLocale)
{
  struct CommaPoint : std::numpunct<char>
  {
    char do_decimal_point () const override { return ','; }
    char do_thousands_sep () const override { return '.'; }
    std::string do_grouping () const override { return "\3"; }
  };
  const TemporaryFolder first, second;
  GetParam ().write (sceneToWrite (), first.file (""));
  std::setlocale (LC_ALL, "de_DE.UTF-8"); // where it is installed
  const std::locale before = std::locale::global (std::locale (std::locale::classic (), new CommaPoint));
  GetParam ().write (sceneToWrite (), second.file (""));
  std::locale::global (before);
  std::setlocale (LC_ALL, "C");
  EXPECT_EQ (filesBelow (first.file ("")), filesBelow (second.file ("")));
}

TEST_P (SceneWriters, leavesNothingWhereItCannotWrite)
{
  const TemporaryFolder folder;
  const std::string missing = folder.file ("missing");
  EXPECT_NE (messageOf<IoError> ([&] { GetParam ().write (sceneToWrite (), missing); }).find (missing),
             std::string::npos);
  EXPECT_EQ (folder.entries (), 0u);
  const FileSizeLimit full_disk (1000); // some of the meshes are smaller
  EXPECT_THROW (GetParam ().write (sceneToWrite (), folder.file ("")), IoError);
  EXPECT_EQ (folder.entries (), 0u);
}

TEST_P (SceneWriters, takesAnEmptyScene)
{
  const TemporaryFolder folder;
  EXPECT_FALSE (GetParam ().write (PhysicalScene (), folder.file ("")).empty ());
}

TEST (SceneJson, hasThePosesAndMasses)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeSceneJson (scene, folder.file (""));
  const json file = json::parse (readFile (folder.file ("scene.json")));
  EXPECT_EQ (file["gravity"], json (asVector (scene.gravity)));
  EXPECT_EQ (file["warnings"].size (), 1u);
  ASSERT_EQ (file["bodies"].size (), scene.bodies.size ());
  const json& box = file["bodies"][0];
  const PhysicalBody& body = scene.bodies[0];
  EXPECT_EQ (box["name"], body.name);
  EXPECT_EQ (box["parts"], 2);
  EXPECT_EQ (box["stands_on"], "table");
  EXPECT_TRUE (file["bodies"][1]["stands_on"].is_null ());
  EXPECT_TRUE (file["bodies"][2]["static"]);
  EXPECT_EQ (box["centre_m"], json (asVector (body.centre_m))); // to the last digit
  EXPECT_EQ (box["inertia"][1][2], body.inertia (1, 2));
  EXPECT_EQ (box["T_scene_body"]["position"], json (asVector (body.T_scene_body.translation ())));
  EXPECT_TRUE (quaternionOf (box["T_scene_body"]["quaternion_xyzw"])
                   .toRotationMatrix ()
                   .isApprox (body.T_scene_body.linear (), 1e-12));
  EXPECT_EQ (file["planes"][1]["size_m"], json ({2.0, 1.6, 0.02}));
}

TEST (UrdfWriter, linksHaveMassesMeshesAndBoxes)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeUrdf (scene, folder.file (""));
  for (const PhysicalBody& body : scene.bodies)
  {
    const auto robot = parseXml (folder.file (body.name + ".urdf"));
    ASSERT_NE (robot, nullptr);
    EXPECT_EQ (robot->GetAttribute ("name"), body.name);
    EXPECT_EQ (elementsOf (robot, "visual").size (), 1u);
    EXPECT_EQ (elementsOf (robot, "collision").size (), body.parts.size ());
    EXPECT_EQ (elementsOf (robot, "joint").size (), body.isStatic () ? 1u : 0u);
    for (Element* mesh : elementsOf (robot, "mesh"))
      EXPECT_FALSE (loadMesh (folder.file (mesh->GetAttribute ("filename"))).empty ());
  }
  const auto box = parseXml (folder.file ("box_1.urdf"));
  EXPECT_EQ (attributeOf (elementsOf (box, "mass").at (0), "value"), std::vector<double>{0.24});
  EXPECT_EQ (attributeOf (elementsOf (box, "origin").at (0), "xyz"), asVector (scene.bodies[0].centre_m));
  EXPECT_EQ (attributeOf (elementsOf (box, "inertia").at (0), "iyz"), std::vector<double>{-3e-6});

  const auto shelf = parseXml (folder.file ("shelf.urdf"));
  ASSERT_NE (shelf, nullptr);
  Element* collision = elementsOf (shelf, "collision").at (0);
  const double top = attributeOf (collision->FindNestedElementWithName ("origin"), "xyz")[2] +
                     0.5 * attributeOf (elementsOf (collision, "box").at (0), "size")[2];
  EXPECT_NEAR (top, 0.0, 1e-15);
}

TEST (SdfWriter, modelsHavePosesMassesAndShapes)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeSdf (scene, folder.file (""));
  const auto sdf = parseXml (folder.file ("scene.sdf"));
  ASSERT_NE (sdf, nullptr);
  EXPECT_EQ (elementsOf (sdf, "world").at (0)->GetAttribute ("name"), scene.name); // escaped
  EXPECT_EQ (numbersOf (elementsOf (sdf, "gravity").at (0)->GetCharacterData ()), asVector (scene.gravity));
  const std::vector<Element*> models = elementsOf (sdf, "model");
  ASSERT_EQ (models.size (), scene.planes.size () + scene.bodies.size ());
  EXPECT_EQ (elementsOf (models[0], "plane").size (), 2u); // visual and collision
  EXPECT_EQ (elementsOf (models[1], "box").size (), 2u);
  for (std::size_t n = 0; n < scene.bodies.size (); ++n)
  {
    Element* model = models[scene.planes.size () + n];
    const PhysicalBody& body = scene.bodies[n];
    EXPECT_EQ (model->GetAttribute ("name"), body.name);
    EXPECT_EQ (elementsOf (model, "static").at (0)->GetCharacterData (),
               std::string (body.isStatic () ? "true" : "false"));
    EXPECT_EQ (elementsOf (model, "inertial").size (), body.isStatic () ? 0u : 1u);
    EXPECT_EQ (elementsOf (model, "collision").size (), body.parts.size ());
    const std::vector<double> pose = numbersOf (elementsOf (model, "pose").at (0)->GetCharacterData ());
    EXPECT_EQ (std::vector<double> (pose.begin (), pose.begin () + 3), asVector (body.T_scene_body.translation ()));
    EXPECT_TRUE (quaternionOf ({pose.begin () + 3, pose.end ()})
                     .toRotationMatrix ()
                     .isApprox (body.T_scene_body.linear (), 1e-12));
  }
  for (Element* uri : elementsOf (sdf, "uri"))
    EXPECT_FALSE (loadMesh (folder.file (uri->GetCharacterData ())).empty ());
}

TEST (MjcfWriter, bodiesHaveJointsMassesAndGeoms)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeMjcf (scene, folder.file (""));
  const auto model = parseXml (folder.file ("scene.xml"));
  ASSERT_NE (model, nullptr);
  EXPECT_EQ (attributeOf (elementsOf (model, "option").at (0), "gravity"), asVector (scene.gravity));
  std::map<std::string, std::string> assets;
  for (Element* mesh : elementsOf (model, "mesh"))
    assets[mesh->GetAttribute ("name")] = folder.file (std::string ("meshes/") + mesh->GetAttribute ("file"));
  for (const auto& [name, path] : assets)
    EXPECT_FALSE (loadMesh (path).empty ()) << name;
  EXPECT_EQ (assets.count ("wall"), 0u); // MuJoCo refuses flat meshes
  EXPECT_EQ (assets.count ("ball_2"), 1u);

  const std::vector<Element*> bodies = elementsOf (model, "body");
  ASSERT_EQ (bodies.size (), scene.bodies.size ());
  for (std::size_t n = 0; n < bodies.size (); ++n)
  {
    EXPECT_EQ (elementsOf (bodies[n], "freejoint").size (), scene.bodies[n].isStatic () ? 0u : 1u);
    for (Element* geom : elementsOf (bodies[n], "geom"))
      EXPECT_EQ (assets.count (geom->GetAttribute ("mesh")), 1u);
  }
  const Eigen::Matrix3d& m = scene.bodies[0].inertia;
  EXPECT_EQ (attributeOf (elementsOf (bodies[0], "inertial").at (0), "fullinertia"),
             (std::vector<double>{m (0, 0), m (1, 1), m (2, 2), m (0, 1), m (0, 2), m (1, 2)}));
  EXPECT_NEAR (attributeOf (bodies[0], "quat")[0], std::cos (0.35), 1e-12);
}

TEST (MeshFiles, ObjKeepsPositionsNormalsAndColours)
{
  const TemporaryFolder folder;
  const PhysicalScene scene = sceneToWrite ();
  writeSdf (scene, folder.file (""));
  const TriangleMesh ball = loadMesh (folder.file ("meshes/ball_2.obj"));
  EXPECT_EQ (ball.vertices, scene.bodies[1].visual.vertices);
  EXPECT_EQ (ball.triangles, scene.bodies[1].visual.triangles);
  EXPECT_NE (readFile (folder.file ("meshes/ball_2.obj")).find ("\nvn 0 0 1\n"), std::string::npos);
  EXPECT_NE (readFile (folder.file ("meshes/box_1.obj")).find ("v 0.05 -0.04 -0.03 0.11764706 0.92156863 0.39215687\n"),
             std::string::npos);
}

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
