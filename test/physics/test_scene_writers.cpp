// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/formats/scene_writers.h"

#include "common/message_of.h"
#include "common/temporary_folder.h"
#include "physics/scene_to_write.h"

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
attributeOf (Element* element, const char* name)
{
  return numbersOf (element->GetAttribute (name));
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

} // namespace
} // namespace pcl::cosection::test
