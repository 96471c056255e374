// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_evaluate stability: scenes whose movement is known.

#include "common/small_meshes.h"
#include "evaluate_fixture.h"
#include "scene_stability.h"

#include <pcl/cosection/common/error.h>

#include <sys/stat.h>

#include <cmath>
#include <filesystem>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double half_m = 0.05; // of a box's side

/** \brief A box whose lowest face is \a gap_m above the floor, which has its top at height 0. */
std::string
boxBody (const std::string& name, double x_m, double gap_m)
{
  return ("<body name='" + name + "' pos='" + std::to_string (x_m) + " 0 " + std::to_string (half_m + gap_m) +
          "'><freejoint/><geom type='box' size='0.05 0.05 0.05' mass='1'/></body>");
}

std::string
sceneText (const std::string& bodies, const std::string& before = "")
{
  return ("<mujoco>" + before + "<worldbody><geom name='floor' type='plane' size='1 1 0.1'/>" + bodies +
          "</worldbody></mujoco>");
}

class Stability : public Evaluate
{
protected:
  void SetUp () override
  {
    if (!canSimulate ())
      GTEST_SKIP () << "this build has no MuJoCo";
  }

  std::string saveScene (const std::string& text, const std::string& name = "scene.xml") const
  {
    writeFile (folder_.file (name), text);
    return (folder_.file (name));
  }
};

} // namespace

TEST_F (Evaluate, SaysThatThisBuildCannotSimulate)
{
  if (canSimulate ())
    GTEST_SKIP () << "this build has MuJoCo";
  writeFile (folder_.file ("scene.xml"), sceneText (boxBody ("box", 0.0, 0.0)));
  EXPECT_EQ (run ({"stability", "scene.xml", "--json", "s.json"}), 1);
  expectOneLine ("this build has no MuJoCo: install libmujoco-dev and build again");
  EXPECT_NE (json ("s.json")["error"].get<std::string> ().find ("libmujoco-dev"), std::string::npos);
}

TEST_F (Stability, ABoxAtRestStays)
{
  const SceneStability scene = simulateScene (saveScene (sceneText (boxBody ("box", 0.3, 0.0))), 5.0);
  ASSERT_EQ (scene.bodies.size (), 1u);
  EXPECT_EQ (scene.bodies[0].name, "box");
  EXPECT_LT (scene.bodies[0].largest_drift_m, 0.0005); // contacts are soft
  EXPECT_LT (scene.bodies[0].largest_turn_rad, 0.001);
  EXPECT_FALSE (scene.bodies[0].flew_away);
  EXPECT_TRUE (scene.bodies[0].stayed (0.003, 0.03));
  EXPECT_FALSE (scene.deepest_contact);
  EXPECT_NEAR (scene.duration_s, 5.0, 1e-9);
  EXPECT_DOUBLE_EQ (scene.time_step_s, 0.002);
  EXPECT_NEAR (scene.extent_m, std::sqrt (3.0) * 2.0 * std::sqrt (3.0) * half_m, 1e-9); // of the ball around it
  EXPECT_TRUE (scene.warnings.empty ());
}

TEST_F (Stability, ABoxInTheAirFalls)
{
  const std::string path = saveScene (sceneText (boxBody ("box", 0.0, 0.01)));
  const SceneStability scene = simulateScene (path, 5.0);
  EXPECT_NEAR (scene.bodies.at (0).drift_m, 0.01, 0.0005);
  EXPECT_GE (scene.bodies[0].largest_drift_m, scene.bodies[0].drift_m);
  EXPECT_FALSE (scene.bodies[0].stayed (0.003, 0.03));
  EXPECT_TRUE (scene.bodies[0].stayed (0.011, 0.03));
  EXPECT_FALSE (scene.bodies[0].flew_away);

  // In free fall, after a time before it lands: g t^2 / 2. The last step counts as well.
  EXPECT_NEAR (simulateScene (path, 0.04).bodies.at (0).drift_m, 0.5 * 9.81 * 0.04 * 0.04, 0.0005);
}

TEST_F (Stability, ADeepContactIsFound)
{
  const std::string bodies = boxBody ("shallow", -0.5, -0.001) + boxBody ("sunk", 0.0, -0.003);
  const SceneStability scene = simulateScene (saveScene (sceneText (bodies)), 0.1);
  ASSERT_TRUE (scene.deepest_contact);
  EXPECT_NEAR (scene.deepest_contact->depth_m, 0.003, 1e-6);
  EXPECT_EQ (scene.deepest_contact->first, "floor");
  EXPECT_EQ (scene.deepest_contact->second, "sunk");
}

TEST_F (Stability, ContactsOfMeshesAreFound)
{
  const auto body = [] (const std::string& name, const std::string& x) {
    return ("<body name='" + name + "' pos='" + x + " 0 0.05'><freejoint/><geom type='mesh' mesh='cube'/></body>");
  };
  const std::string asset = "<asset><mesh name='cube' file='cube.obj'/></asset>";
  saveMesh (boxMesh ({-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}), folder_.file ("cube.obj"));
  const std::string path = saveScene (sceneText (body ("left", "0") + body ("right", "0.098"), asset));
  const SceneStability scene = simulateScene (path, 0.1);
  ASSERT_TRUE (scene.deepest_contact);
  EXPECT_NEAR (scene.deepest_contact->depth_m, 0.002, 2e-5); // a solver that stops at a tolerance
  EXPECT_EQ (scene.deepest_contact->first, "left");
  EXPECT_EQ (scene.deepest_contact->second, "right");
}

TEST_F (Stability, ATiltedBoxTurns)
{
  // On an edge, a little beyond the balance: it falls onto its side.
  const std::string body = "<body name='box' pos='0 0 0.0708' euler='0 46 0'><freejoint/><geom type='box' "
                           "size='0.05 0.05 0.05' mass='1'/></body>";
  const SceneStability scene = simulateScene (saveScene (sceneText (body)), 5.0);
  EXPECT_NEAR (scene.bodies.at (0).turn_rad, 44.0 * M_PI / 180.0, 0.03);
  EXPECT_GE (scene.bodies[0].largest_turn_rad, scene.bodies[0].turn_rad);
}

TEST_F (Stability, WhatNothingHoldsFliesAway)
{
  const std::string text = "<mujoco><worldbody><body><freejoint/><geom type='box' size='0.05 0.05 0.05'/></body>"
                           "</worldbody></mujoco>";
  const SceneStability scene = simulateScene (saveScene (text), 5.0);
  EXPECT_EQ (scene.bodies.at (0).name, "body 1"); // it has none in the file
  EXPECT_TRUE (scene.bodies[0].flew_away);
  EXPECT_NEAR (scene.bodies[0].drift_m, 0.5 * 9.81 * 25.0, 0.5);
  EXPECT_FALSE (scene.bodies[0].stayed (1e9, 10.0));
}

TEST_F (Stability, AnUnstableSceneIsAnError)
{
  const std::string before = "<option gravity='0 0 -1e12'/>"; // accelerations that MuJoCo does not accept
  saveScene (sceneText (boxBody ("box", 0.0, -0.01), before));
  EXPECT_EQ (run ({"stability", "scene.xml", "--json", "s.json", "--csv", "s.csv"}), 1);
  expectOneLine ("scene.xml: the simulation fails after ");
  expectOneLine ("the deepest contact is 10 mm, between floor and box");
  EXPECT_NE (json ("s.json")["error"].get<std::string> ().find ("the simulation fails"), std::string::npos);
  EXPECT_FALSE (std::filesystem::exists (folder_.file ("s.csv")));
  EXPECT_EQ (output_, "");
}

TEST_F (Stability, LeftOutContactsAreAnError)
{
  std::string bodies;
  for (int n = 0; n < 6; ++n)
    bodies += boxBody ("box_" + std::to_string (n), 0.2 * n, -0.001);
  saveScene (sceneText (bodies, "<size nconmax='3'/>"));
  EXPECT_EQ (run ({"stability", "scene.xml"}), 1);
  expectOneLine ("the simulation fails after 0 s");
}

TEST_F (Stability, SaysWhatIsWrongWithAScene)
{
  writeFile (folder_.file ("text.xml"), "no XML\nat all\n");
  writeFile (folder_.file ("empty.xml"), "");
  writeFile (folder_.file ("other.xml"), "<scene>\n<body/></scene>");
  writeFile (folder_.file ("unknown.xml"), "<mujoco><worldbody><thing/></worldbody></mujoco>");
  writeFile (folder_.file ("mesh.xml"), "<mujoco><asset><mesh name='m' file='no.obj'/></asset></mujoco>");
  writeFile (folder_.file ("fixed.xml"), sceneText ("<body><geom type='sphere' size='1'/></body>"));
  writeFile (folder_.file ("step.xml"), sceneText (boxBody ("box", 0, 0), "<option timestep='1e-300'/>"));
  writeFile (folder_.file ("back.xml"), sceneText (boxBody ("box", 0, 0), "<option timestep='-10'/>"));
  writeFile (folder_.file ("waits.xml"), "<mujoco><include file=\"pipe\"/></mujoco>");
  writeFile (folder_.file ("deep.xml"), "<mujoco><include file='waits.xml'/><include file='deep.xml'/></mujoco>");
  writeFile (folder_.file ("reads.xml"),
             "<mujoco><compiler meshdir='meshes'/><asset><mesh\nname='m' file = 'other pipe'/></asset></mujoco>");
  writeFile (folder_.file ("device.xml"), "<mujoco><asset><texture type='cube' fileup='/dev/zero'/></asset></mujoco>");
  std::filesystem::create_directory (folder_.file ("nothing"));
  std::filesystem::create_directory (folder_.file ("meshes"));
  ASSERT_EQ (::mkfifo (folder_.file ("pipe").c_str (), 0600), 0);
  ASSERT_EQ (::mkfifo (folder_.file ("meshes/other pipe").c_str (), 0600), 0);
  const std::size_t entries = folder_.entries ();
  for (const auto& [file, part] :
       std::vector<std::pair<std::string, std::string>>{{"text.xml", "text.xml: XML parse error"},
                                                        {"empty.xml", "empty.xml: XML parse error"},
                                                        {"other.xml", "other.xml: "},
                                                        {"unknown.xml", "unrecognized element"},
                                                        {"mesh.xml", "no.obj"},
                                                        {"fixed.xml", "fixed.xml: has no body with a free joint"},
                                                        {"step.xml", "time step of 1e-300 s: too many steps"},
                                                        {"back.xml", "not greater than 0"},
                                                        {"waits.xml", "names 'pipe', which is not a regular file"},
                                                        {"deep.xml", "names 'pipe', which is not a regular file"},
                                                        {"reads.xml", "names 'meshes/other pipe', which is not"},
                                                        {"device.xml", "names '/dev/zero', which is not"},
                                                        {"missing.xml", "cannot read 'missing.xml'"},
                                                        {"nothing", "cannot read 'nothing/scene.xml'"},
                                                        {"pipe", "cannot read 'pipe': not a regular file"}})
  {
    EXPECT_EQ (run ({"stability", file, "--json", "s.json"}), 1) << file;
    expectOneLine (part);
    EXPECT_NE (json ("s.json")["error"].get<std::string> ().find (file), std::string::npos);
    EXPECT_EQ (output_, "");
    std::filesystem::remove (folder_.file ("s.json"));
  }
  EXPECT_LE (folder_.entries (), entries + 2); // what the program printed; MuJoCo leaves no file of its own
  EXPECT_FALSE (std::filesystem::exists (folder_.file ("MUJOCO_LOG.TXT")));
}

TEST_F (Stability, SimulatesWhatAFolderHas)
{
  std::filesystem::create_directory (folder_.file ("folder"));
  saveScene (sceneText (boxBody ("rests", -0.3, 0.0) + boxBody ("falls", 0.3, 0.01)), "folder/scene.xml");
  ASSERT_EQ (run ({"stability", "folder", "--json", "s.json", "--csv", "s.csv", "--seconds", "2"}), 0) << errors_;
  EXPECT_EQ (errors_, "");
  EXPECT_NE (output_.find ("1 of 2 bodies stayed (50.0 %), within 3 mm and 2 degrees after 2 s"), std::string::npos)
      << output_;
  EXPECT_NE (output_.find ("no bodies overlap at the start"), std::string::npos) << output_;
  const nlohmann::json all = json ("s.json");
  ASSERT_EQ (all["bodies"].size (), 2u);
  EXPECT_EQ (all["bodies"][0]["name"], "rests");
  EXPECT_EQ (all["bodies"][0]["stayed"], true);
  EXPECT_NEAR (all["bodies"][1]["drift_m"].get<double> (), 0.01, 0.0005);
  EXPECT_EQ (all["bodies"][1]["stayed"], false);
  EXPECT_EQ (all["bodies"][1]["flew_away"], false);
  EXPECT_TRUE (all["deepest_contact"].is_null ());
  EXPECT_EQ (all["summary"]["bodies"], 2);
  EXPECT_EQ (all["summary"]["stayed"], 1);
  EXPECT_EQ (all["summary"]["stayed_share"], 0.5);
  EXPECT_EQ (all["summary"]["flew_away"], 0);
  EXPECT_EQ (all["parameters"]["seconds"], 2.0);
  const std::string csv = readFile (folder_.file ("s.csv"));
  EXPECT_EQ (std::count (csv.begin (), csv.end (), '\n'), 3);
  EXPECT_NE (csv.find ("\nfalls,0.0"), std::string::npos) << csv;

  EXPECT_EQ (run ({"stability", "folder", "--max-drift", "0.02", "--quiet"}), 0);
  EXPECT_EQ (output_ + errors_, "");
  EXPECT_EQ (run ({"stability", "folder", "--max-drift", "0.02"}), 0);
  EXPECT_NE (output_.find ("2 of 2 bodies stayed (100.0 %), within 20 mm"), std::string::npos) << output_;
}

TEST_F (Stability, ResultsAreTheSameInEveryRun)
{
  const std::string path = saveScene (sceneText (boxBody ("a", 0.0, 0.02) + boxBody ("b", 0.03, 0.15)));
  const SceneStability first = simulateScene (path, 2.0), second = simulateScene (path, 2.0);
  ASSERT_EQ (first.bodies.size (), second.bodies.size ());
  for (std::size_t n = 0; n < first.bodies.size (); ++n)
  {
    EXPECT_EQ (first.bodies[n].drift_m, second.bodies[n].drift_m);
    EXPECT_EQ (first.bodies[n].turn_rad, second.bodies[n].turn_rad);
  }
}

TEST_F (Stability, ReportsProgressAndCanBeCancelled)
{
  const std::string path = saveScene (sceneText (boxBody ("box", 0.0, 0.0)));
  std::vector<double> fractions;
  simulateScene (path, 1.0, [&] (const std::string&, double fraction) {
    fractions.push_back (fraction);
    return (true);
  });
  EXPECT_GE (fractions.size (), 50u);
  EXPECT_TRUE (std::is_sorted (fractions.begin (), fractions.end ()));
  EXPECT_LE (fractions.back (), 1.0);
  EXPECT_THROW (simulateScene (path, 1000.0, [] (const std::string&, double) { return (false); }), Cancelled);
}

TEST_F (Stability, RefusesWrongArguments)
{
  saveScene (sceneText (boxBody ("box", 0.0, 0.0)));
  for (const auto& [words, part] :
       std::vector<std::pair<Words, std::string>>{{{"stability"}, "SCENE is missing"},
                                                  {{"stability", ""}, "SCENE must not be empty"},
                                                  {{"stability", "a", "b"}, "one argument too many: b"},
                                                  {{"stability", "--seconds", "0", "scene.xml"}, "--seconds"},
                                                  {{"stability", "--max-drift", "-1", "scene.xml"}, "--max-drift"},
                                                  {{"stability", "--max-turns", "1", "scene.xml"}, "--max-turn?"},
                                                  {{"stability", "--json", "scene.xml", "scene.xml"}, "overwritten"},
                                                  {{"stability", "--csv", "scene.xml", "."}, "overwritten"}})
  {
    EXPECT_EQ (run (words), 2);
    expectOneLine (part);
  }
}
