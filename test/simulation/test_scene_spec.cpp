// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/replaced.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <fstream>

using namespace pcl::cosection;

namespace {

/** \brief A small good description, with something replaced. */
std::string
spec (const std::string& what = "", const std::string& with = "")
{
  std::string text = R"({
    "camera": {"width": 64, "height": 48, "keys": [{"position": [0, -1, 0.5], "look_at": [0, 0, 0]}]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "keys": [{"position": [0, 0, 0.1]}]}]
  })";
  if (!what.empty ())
  {
    const std::size_t at = text.find (what);
    EXPECT_NE (at, std::string::npos) << what;
    text.replace (at, what.size (), with);
  }
  return text;
}

std::string
errorOf (const std::string& text)
{
  try
  {
    parseSceneSpec (text, "a.json");
  }
  catch (const Error& error)
  {
    const std::string what = error.what ();
    EXPECT_EQ (what.find ('\n'), std::string::npos) << what;
    EXPECT_EQ (what.rfind ("a.json: ", 0), 0u) << what;
    return what.substr (8);
  }
  ADD_FAILURE () << "no error: " << text;
  return "";
}

} // namespace

TEST (SceneSpec, DefaultsAreSaid)
{
  const SimulatedScene scene = parseSceneSpec (spec (), "a.json");
  EXPECT_EQ (scene.frames, 1);
  EXPECT_EQ (scene.camera.width, 64);
  EXPECT_NEAR (scene.camera.fx, 52.5, 1e-9);
  EXPECT_NEAR (scene.camera.cx, 31.5, 1e-9);
  EXPECT_TRUE (scene.noise.has_value ());
  EXPECT_EQ (scene.depth_format, DepthFormat::Png);
  ASSERT_EQ (scene.bodies.size (), 2u);
  EXPECT_EQ (scene.bodies[1].id, 1);
  EXPECT_NEAR (scene.bodies[1].distance ({0.0, 0.0, 0.3}), 0.2, 1e-12);
}

TEST (SceneSpec, CommentsAreAllowed)
{
  EXPECT_NO_THROW (parseSceneSpec ("// a scene\n" + spec (), "a.json"));
}

TEST (SceneSpec, EveryMistakeIsNamed)
{
  const std::string sphere = R"("type": "sphere", "radius": 0.1)";
  const std::vector<std::array<std::string, 3>> cases = {
      {"\"objects\"", "\"objekts\"", "lacks the field \"objects\""},
      {"\"objects\"", "\"frame\": 3, \"objects\"",
       "has the unknown field \"frame\"; its fields are background, camera"},
      {"\"radius\"", "\"radious\"", "objects[0].shape lacks the field \"radius\""},
      {sphere, sphere + ", \"size\": 3", "objects[0].shape has the unknown field \"size\""},
      {"0.1}", "-0.1}", "objects[0].shape is not right: radius must be a positive number"},
      {"0.1}", "\"a\"}", "objects[0].shape.radius must be a number"},
      {"\"sphere\"", "\"spere\"", "objects[0].shape.type is \"spere\"; it must be one of sphere, box"},
      {"[0, 0, 0.1]", "[0, 0]", "objects[0].keys[0].position must be 3 numbers"},
      {"[0, 0, 0.1]", "7", "objects[0].keys[0].position must be a list"},
      {"\"width\": 64", "\"width\": 0", "camera.width must be a whole number from 1 to 8192"},
      {"\"width\": 64", "\"width\": 64, \"fx\": -3", "camera has an impossible fx"},
      {"\"width\": 64", "\"width\": 64, \"fx\": 1e300", "camera has an impossible fx"},
      {"\"width\": 64", "\"width\": 64, \"cx\": 5000", "camera has a principal point cx, cy far outside the image"},
      {"[0, 0, 0]", "[0, -1, 0.5]", "camera.keys are not right: look_at is where the camera is"},
      {"\"look_at\": [0, 0, 0]", "\"look_at\": [0, 0, 0], \"rpy_deg\": [0, 0, 0]",
       "camera.keys[0] has both look_at and a rotation"},
      {"\"name\": \"ball\"", "\"name\": \"a/b\"", "\"a/b\" is no name for an object"},
      {"\"name\": \"ball\"", "\"name\": \"room\"", "an object must not be called room"},
      {"\"name\": \"ball\"", "\"name\": \"cam\"", "an object must not be called cam"},
      {"\"name\": \"ball\"", "\"name\": \"..\"", "\"..\" is no name for an object"},
      {"\"name\": \"ball\"", "\"name\": \"a\\u0000b\"", "\"a?b\" is no name for an object"},
      {"\"name\": \"ball\"", "\"name\": \"a\", \"name\": \"b\"", "has the field \"name\" twice in one object"},
      {"\"name\": \"ball\"", "\"na\\nme\": \"a\"", "objects[0] has the unknown field \"na?me\""},
      {"\"name\": \"ball\"", "\"a\\tb\": 1, \"a\\tb\": 2", "has the field \"a?b\" twice in one object"},
      {"\"sphere\"", "\"sph\\nere\"", "objects[0].shape.type is \"sph?ere\"; it must be one of sphere, box"},
      {"\"objects\"", "\"background\": {\"name\": \"wall\", \"parts\": []}, \"objects\"",
       "the background is called wall"},
      {"\"name\": \"ball\"", "\"id\": 0", "objects[0].id must be a whole number from 1 to 65534"},
      {"\"name\": \"ball\"", "\"colour\": [1, 2, 300]", "objects[0].colour[2] must be a whole number from 0 to 255"},
      {"{\"position\": [0, 0, 0.1]}", "", "objects[0].keys must have at least 1 element"},
      {"{\"position\": [0, 0, 0.1]}", "{\"position\": [0, 0, 0]}, {\"position\": [0, 0, 1]}",
       "objects[0].keys are not right: keys: the time of key 1 is not after that of the key before"},
      {"\"objects\"", "\"depth\": {\"noise\": {\"dropout\": 2}}, \"objects\"",
       "depth.noise is not right: dropout must be a probability"},
      {"\"objects\"", "\"depth\": {\"format\": \"tiff\"}, \"objects\"",
       "depth.format is \"tiff\"; it must be one of png, exr"},
      {"\"objects\"", "\"frames\": 0, \"objects\"", "frames must be a whole number"},
      {"\"objects\"", "\"rate\": 0, \"objects\"", "rate must be a positive number"},
      {"\"objects\": [", "\"objects\": 3, \"x\": [", "objects must be a list"},
      {sphere, "\"type\": \"mesh\", \"file\": \"nowhere.ply\"", "nowhere.ply"},
      {sphere, "\"type\": \"revolution\", \"profile\": [[0, 0], [1, 0]]",
       "objects[0].shape.profile must have at least 3 elements"},
  };
  for (const auto& [what, with, message] : cases)
    if (message == "nowhere.ply")
      EXPECT_THROW (parseSceneSpec (spec (what, with), "a.json"), IoError);
    else
      EXPECT_NE (errorOf (spec (what, with)).find (message), std::string::npos) << errorOf (spec (what, with));
  EXPECT_EQ (errorOf ("{").rfind ("is not well-formed JSON", 0), 0u);
  EXPECT_EQ (errorOf ("[]").rfind ("must be an object", 0), 0u);
}

TEST (SceneSpec, ACameraThatPassesWhatItLooksAtIsSaid)
{
  const std::string keys = "\"look_at\": [0, 0, 0]}, {\"time\": 1, \"position\": [0, 1, -0.5], \"look_at\": [0, 0, 0]}";
  const std::string text = test::replaced (spec ("\"look_at\": [0, 0, 0]}", keys), "\"objects\"",
                                           "\"frames\": 3, \"rate\": 2, \"objects\"");
  EXPECT_NE (errorOf (text).find ("camera.keys are not right: at frame 1, look_at is where the camera is"),
             std::string::npos)
      << errorOf (text);
}

TEST (SceneSpec, NamesHaveADefault)
{
  EXPECT_EQ (parseSceneSpec (spec ("\"name\": \"ball\"", "\"id\": 7"), "a.json").bodies[1].name, "object_7");
}

TEST (SceneSpec, WhatIsChangedIsInTheDescription)
{
  SimulatedScene scene = parseSceneSpec (spec (), "a.json");
  scene.seed = 9;
  scene.noise.reset ();
  scene.views_every = 4;
  const SimulatedScene again = parseSceneSpec (effectiveSpec (scene), "again");
  EXPECT_EQ (again.seed, 9u);
  EXPECT_FALSE (again.noise);
  EXPECT_EQ (again.views_every, 4);
}

TEST (SceneSpec, MeshesAreFoundBesideTheFile)
{
  const test::TemporaryFolder folder;
  saveMesh (makeSphere (1.0)->tessellate (1e-3), folder.file ("ball.ply"));
  std::ofstream (folder.file ("a.json")) << spec (R"("type": "sphere", "radius": 0.1)",
                                                  R"("type": "mesh", "file": "ball.ply", "scale": 0.1)");
  const SimulatedScene scene = loadSceneSpec (folder.file ("a.json"));
  EXPECT_NEAR (scene.bodies[1].distance ({0.0, 0.0, 0.105}), 0.005, 5e-4);
  EXPECT_THROW (loadSceneSpec (folder.file ("b.json")), IoError);
  EXPECT_EQ (scene.bodies[1].parts[0].file, folder.file ("ball.ply"));
  EXPECT_NO_THROW (parseSceneSpec (effectiveSpec (scene), "from elsewhere", "/"));
}

TEST (SceneSpec, WhatWasReadCanBeReadAgain)
{
  for (const ScenePreset& preset : scenePresets ())
  {
    const SimulatedScene scene = parseSceneSpec (preset.spec, preset.name);
    EXPECT_EQ (parseSceneSpec (scene.spec, "again").spec, scene.spec);
  }
}
