// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_evaluate as its users meet it: commands, options, files and what it says of bad ones.

#include "evaluate_fixture.h"
#include "evaluation/moving_scene.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <iomanip>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

std::string
poseLines (const std::vector<StampedPose>& poses)
{
  std::ostringstream text;
  text << std::setprecision (12);
  for (const StampedPose& stamped : poses)
  {
    const Eigen::Quaterniond q (stamped.pose.linear ());
    const Eigen::Vector3d t = stamped.pose.translation ();
    text << stamped.stamp << ' ' << t.x () << ' ' << t.y () << ' ' << t.z () << ' ' << q.x () << ' ' << q.y () << ' '
         << q.z () << ' ' << q.w () << '\n';
  }
  return (text.str ());
}

void
writeDataset (const SceneRecord& truth, const TemporaryFolder& folder)
{
  std::filesystem::create_directories (folder.file ("dataset/gt-mesh"));
  writeFile (folder.file ("dataset/gt-cam-0.txt"), poseLines (truth.camera));
  writeFile (folder.file ("dataset/calibration.txt"), "260 260 159.5 119.5 320 240\n");
  for (const SceneRecord::Object& object : truth.objects)
  {
    writeFile (folder.file ("dataset/gt-" + object.name + "-" + std::to_string (object.id) + ".txt"),
               poseLines (object.poses));
    saveMesh (object.mesh, folder.file ("dataset/gt-mesh/" + object.name + ".ply"));
  }
  saveMesh (truth.background, folder.file ("dataset/gt-mesh/room.ply"));
}

void
writeRun (const SceneRecord& estimate, const TemporaryFolder& folder)
{
  std::filesystem::create_directories (folder.file ("run/trajectory"));
  std::filesystem::create_directories (folder.file ("run/mesh"));
  writeFile (folder.file ("run/trajectory/camera.txt"), poseLines (estimate.camera));
  for (const SceneRecord::Object& object : estimate.objects)
  {
    writeFile (folder.file ("run/trajectory/object_" + object.name + ".txt"), poseLines (object.poses));
    if (!object.mesh.empty ())
      saveMesh (object.mesh, folder.file ("run/mesh/object_" + object.name + ".ply"));
  }
  if (!estimate.background.empty ())
    saveMesh (estimate.background, folder.file ("run/mesh/background.ply"));
}

} // namespace

TEST_F (Evaluate, NeedsACommand)
{
  EXPECT_EQ (run ({}), 2);
  EXPECT_NE (output_.find ("Commands:"), std::string::npos);
  expectOneLine ("a command is missing");
  EXPECT_EQ (run ({"--help"}), 0);
  EXPECT_EQ (errors_, "");
  EXPECT_EQ (run ({"--version"}), 0);
  EXPECT_EQ (output_.rfind ("pcl_cosection_evaluate ", 0), 0u);
  EXPECT_EQ (run ({"mehs", "a.ply", "b.ply"}), 2);
  expectOneLine ("did you mean mesh?");
  EXPECT_EQ (run ({"frobnicate"}), 2);
  expectOneLine ("known are mesh, trajectory, run, views and stability");
  EXPECT_EQ (run ({"--json", "a.json", "mesh"}), 2);
  expectOneLine ("the command must come first");
}

TEST_F (Evaluate, RefusesWrongArguments)
{
  save ("a.ply", sphereMesh (0.1, 8));
  EXPECT_EQ (run ({"mesh"}), 2);
  expectOneLine ("TRUTH and RECONSTRUCTION are missing");
  EXPECT_EQ (run ({"mesh", "a.ply"}), 2);
  expectOneLine ("RECONSTRUCTION is missing after a.ply");
  EXPECT_EQ (run ({"mesh", "a.ply", "a.ply", "b.ply"}), 2);
  expectOneLine ("one argument too many: b.ply");
  EXPECT_EQ (run ({"mesh", "--sample", "5", "a.ply", "a.ply"}), 2);
  expectOneLine ("did you mean --samples?");
  EXPECT_EQ (run ({"mesh", "--samples", "0", "a.ply", "a.ply"}), 2);
  expectOneLine ("--samples");
  EXPECT_EQ (run ({"mesh", "--pose", "1,2,3", "a.ply", "a.ply"}), 2);
  expectOneLine ("seven numbers");
  EXPECT_EQ (run ({"mesh", "--pose", "0,0,0,0,0,0,0", "a.ply", "a.ply"}), 2);
  expectOneLine ("length zero");
  EXPECT_EQ (run ({"mesh", "--error-mesh", "e.stl", "a.ply", "a.ply"}), 2);
  expectOneLine ("must end in .ply");
  EXPECT_EQ (run ({"mesh", "--error-mesh", "a.ply", "a.ply", "a.ply"}), 2);
  expectOneLine ("would be overwritten");
  EXPECT_EQ (run ({"mesh", "--json", "x", "--csv", "./x", "a.ply", "a.ply"}), 2);
  expectOneLine ("written twice");
  EXPECT_EQ (run ({"trajectory", "--delta", "0", "a", "b"}), 2);
  expectOneLine ("--delta");
  EXPECT_EQ (run ({"trajectory", "--align", "sim3", "a", "b"}), 2);
  expectOneLine ("--align");
}

TEST_F (Evaluate, SaysWhatIsWrongWithAMesh)
{
  save ("good.ply", sphereMesh (0.1, 8));
  writeFile (folder_.file ("points.off"), "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  writeFile (folder_.file ("nan.off"), "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n");
  writeFile (folder_.file ("flat.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  writeFile (folder_.file ("empty.ply"), "");
  for (const auto& [file, part] : std::map<std::string, std::string>{{"points.off", "no triangles"},
                                                                     {"nan.off", "nan.off"},
                                                                     {"flat.off", "without area"},
                                                                     {"empty.ply", "empty"},
                                                                     {"missing.ply", "missing.ply"}})
  {
    EXPECT_EQ (run ({"mesh", "good.ply", file, "--json", "failure.json"}), 1) << file;
    expectOneLine (part);
    EXPECT_NE (json ("failure.json")["error"].get<std::string> ().find (file), std::string::npos);
    EXPECT_EQ (run ({"mesh", file, "good.ply"}), 1) << file;
    expectOneLine (file);
  }
}

TEST_F (Evaluate, ComparesMeshes)
{
  save ("truth.ply", boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.2f, 0.3f}));
  save ("moved.stl", boxMesh ({1.0f, 0.0f, 0.0f}, {1.1f, 0.2f, 0.3f}));
  EXPECT_EQ (run ({"mesh", "truth.ply", "moved.stl", "--pose", "-1,0,0,0,0,0,1", "--json", "e.json", "--csv", "e.csv"}),
             0)
      << errors_;
  EXPECT_EQ (errors_, "");
  nlohmann::json result = json ("e.json");
  EXPECT_LT (result["accuracy_m"].get<double> (), 1e-6);
  EXPECT_LT (result["completeness_m"].get<double> (), 1e-6);
  EXPECT_EQ (result["f_score"], 1.0);
  EXPECT_EQ (result["closed"], true);
  EXPECT_NEAR (result["volume_error"].get<double> (), 0.0, 1e-5);
  EXPECT_NEAR (result["truth"]["volume_m3"].get<double> (), 0.006, 1e-7);
  const std::string csv = readFile (folder_.file ("e.csv"));
  EXPECT_EQ (std::count (csv.begin (), csv.end (), '\n'), 2);
  EXPECT_NE (csv.find ("accuracy_m"), std::string::npos);

  // Without the pose: numbers, and a warning.
  EXPECT_EQ (run ({"mesh", "truth.ply", "moved.stl"}), 0);
  EXPECT_NE (errors_.find ("do not overlap"), std::string::npos);
  EXPECT_EQ (run ({"mesh", "truth.ply", "moved.stl", "--quiet"}), 0);
  EXPECT_EQ (output_ + errors_, "");

  save ("open.ply", upperPart (sphereMesh (0.1, 8)));
  EXPECT_EQ (run ({"mesh", "truth.ply", "open.ply", "--json", "e.json"}), 0);
  EXPECT_NE (output_.find ("note: the reconstruction is open and has no volume"), std::string::npos) << output_;
  EXPECT_TRUE (json ("e.json")["volume_error"].is_null ());
}

TEST_F (Evaluate, AlignsByIcp)
{
  const TriangleMesh truth = boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.2f, 0.3f});
  save ("truth.ply", truth);
  save ("moved.ply", transformMesh (truth, motion (0.05, {1.0, 1.0, 0.3}, {0.006, 0.004, -0.005})));
  EXPECT_EQ (run ({"mesh", "truth.ply", "moved.ply", "--json", "none.json"}), 0);
  EXPECT_EQ (run ({"mesh", "truth.ply", "moved.ply", "--align", "icp", "--json", "icp.json"}), 0);
  EXPECT_GT (json ("none.json")["accuracy_m"].get<double> (), 0.002);
  EXPECT_LT (json ("icp.json")["accuracy_m"].get<double> (), 1e-4);
}

TEST_F (Evaluate, MeasuresObstaclesAndFreeSpace)
{
  save ("box.ply", boxMesh ({-0.05f, -0.05f, 0.9f}, {0.05f, 0.05f, 1.0f}));
  save ("block.ply", boxMesh ({0.04f, -0.1f, 0.8f}, {0.2f, 0.1f, 1.2f}));
  pcl::PointCloud<pcl::PointXYZ> view;
  view.width = 64;
  view.height = 48;
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) // a wall behind the box
      view.push_back (pcl::PointXYZ (1.2f * (u - 31.5f) / 60.0f, 1.2f * (v - 23.5f) / 60.0f, 1.2f));
  view.width = 64;
  view.height = 48;
  pcl::io::savePCDFileBinary (folder_.file ("view.pcd"), view);
  ASSERT_EQ (
      run ({"mesh", "box.ply", "box.ply", "--obstacle", "block.ply", "--free-space", "view.pcd", "--json", "e.json"}),
      0)
      << errors_;
  const nlohmann::json result = json ("e.json");
  EXPECT_NEAR (result["penetration_m"].get<double> (), 0.01, 1e-6);
  EXPECT_NEAR (result["obstacles"][0]["penetration_m3"].get<double> (), 1e-4, 5e-6);
  EXPECT_EQ (result["free_space"]["violation"], 1.0);
  EXPECT_NEAR (result["free_space"]["max_depth_m"].get<double> (), 0.3, 1e-4);

  save ("floor.ply", planeMesh (1.0, 2, 0.95));
  EXPECT_EQ (run ({"mesh", "box.ply", "box.ply", "--obstacle", "floor.ply"}), 0);
  EXPECT_NE (errors_.find ("floor.ply is open and has no inside"), std::string::npos) << errors_;
}

TEST_F (Evaluate, ShowsErrors)
{
  save ("truth.ply", sphereMesh (0.1, 16));
  save ("rec.ply", sphereMesh (0.11, 16));
  EXPECT_EQ (run ({"mesh", "truth.ply", "rec.ply", "--error-picture", "e.png", "--error-mesh", "e.ply", "--error-max",
                   "0.02"}),
             0);
  EXPECT_EQ (readFile (folder_.file ("e.png")).substr (1, 3), "PNG");
  const TriangleMesh mesh = loadPlyMesh (folder_.file ("e.ply"));
  ASSERT_EQ (mesh.colours.size (), mesh.vertices.size ());
  for (const auto& colour : mesh.colours) // 1 cm of 2: the middle of the scale, green to yellow
  {
    EXPECT_GT (colour[1], 150);
    EXPECT_LT (colour[2], 150);
  }
}

TEST_F (Evaluate, ComparesTrajectories)
{
  SceneRecord truth = movingScene ();
  std::vector<StampedPose> estimate = inOtherFrames (truth).camera;
  estimate.erase (estimate.begin () + 5, estimate.begin () + 9);
  writeFile (folder_.file ("gt.txt"), poseLines (truth.camera));
  writeFile (folder_.file ("est.txt"), poseLines (estimate));
  EXPECT_EQ (run ({"trajectory", "gt.txt", "est.txt", "--json", "t.json", "--csv", "t.csv"}), 0) << errors_;
  const nlohmann::json result = json ("t.json");
  EXPECT_LT (result["ate_rmse_m"].get<double> (), 1e-6);
  EXPECT_LT (result["rpe_trans_rmse_m"].get<double> (), 1e-6);
  EXPECT_LT (result["rpe_rot_rmse_deg"].get<double> (), 1e-3);
  EXPECT_EQ (result["matched"], 20);
  EXPECT_EQ (result["rpe_left_out"], 1);
  EXPECT_NE (output_.find ("83.3 % of the truth and 100.0 % of the estimate"), std::string::npos) << output_;

  for (StampedPose& pose : estimate)
    pose.stamp += 1000.0;
  writeFile (folder_.file ("late.txt"), poseLines (estimate));
  EXPECT_EQ (run ({"trajectory", "gt.txt", "late.txt"}), 1);
  expectOneLine ("late.txt: no stamps match within 0.5: the truth has 0 to 23, the estimate 1000 to 1023");
  EXPECT_EQ (run ({"trajectory", "gt.txt", "missing.txt"}), 1);
  expectOneLine ("missing.txt");
}

TEST_F (Evaluate, EvaluatesARun)
{
  const SceneRecord truth = movingScene ();
  SceneRecord estimate = inOtherFrames (truth);
  SceneRecord::Object ghost = estimate.objects[0];
  ghost.id = 30;
  ghost.name = "30";
  ghost.mesh = {};
  estimate.objects.push_back (ghost);
  estimate.background = {};
  writeDataset (truth, folder_);
  writeRun (estimate, folder_);
  ASSERT_EQ (run ({"run", "run", "dataset", "--json", "r.json", "--csv", "r.csv"}), 0) << errors_;
  EXPECT_NE (errors_.find ("estimated object 30 has no mesh"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("the estimate has no background"), std::string::npos) << errors_;
  const nlohmann::json result = json ("r.json");
  ASSERT_EQ (result["objects"].size (), 2u);
  EXPECT_EQ (result["objects"][0]["id"], 7);
  EXPECT_EQ (result["objects"][0]["truth"], "box");
  for (const nlohmann::json& object : result["objects"])
  {
    EXPECT_LT (object["accuracy_m"].get<double> (), 1e-5);
    EXPECT_LT (object["completeness_m"].get<double> (), 1e-5);
    EXPECT_EQ (object["f_score"], 1.0);
    EXPECT_EQ (object["closed"], true);
    EXPECT_EQ (object["penetration_m"], 0.0);
    EXPECT_LT (object["ate_rmse_m"].get<double> (), 1e-5);
    EXPECT_LT (object["rpe_trans_rmse_m"].get<double> (), 1e-5);
    EXPECT_LT (object["rpe_rot_rmse_deg"].get<double> (), 1e-3);
  }
  EXPECT_LT (result["camera"]["ate_rmse_m"].get<double> (), 1e-6);
  EXPECT_TRUE (result["background"].is_null ());
  EXPECT_EQ (result["unmatched"], nlohmann::json::array ({30}));
  EXPECT_EQ (result["warnings"].size (), 2u);

  // A mesh that cannot be read does not lose the others.
  writeFile (folder_.file ("run/mesh/object_7.ply"), "ply\nnonsense\n");
  EXPECT_EQ (run ({"run", "run", "dataset", "--json", "r.json"}), 1);
  EXPECT_NE (errors_.find ("object_7.ply"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("the rest was evaluated"), std::string::npos) << errors_;
  EXPECT_EQ (json ("r.json")["objects"].size (), 1u);
  EXPECT_EQ (json ("r.json")["missed"][0]["truth"], "box");

  std::filesystem::remove (folder_.file ("run/trajectory/camera.txt"));
  EXPECT_EQ (run ({"run", "run", "dataset"}), 1);
  expectOneLine ("camera.txt");
  EXPECT_EQ (run ({"run", "nowhere", "dataset"}), 1);
  expectOneLine ("nowhere: is no folder");
  EXPECT_EQ (run ({"run", "dataset", "run"}), 1);
  expectOneLine ("is a dataset, not what a run wrote");
}

TEST_F (Evaluate, ManyScenesMustHaveResultsInMetres)
{
  for (const char* folder : {"truth/a", "result/a", "none"})
    std::filesystem::create_directories (folder_.file (folder));
  save ("truth/a/truth_1.ply", sphereMesh (0.1, 24));
  EXPECT_EQ (run ({"views", "truth", "nowhere"}), 1);
  expectOneLine ("nowhere: cannot be read");
  EXPECT_EQ (run ({"views", "truth", "none"}), 1);
  expectOneLine ("none: has none of the 1 object of truth; the first would be none/a/object_1.ply");
  save ("result/a/object_1.stl", sphereMesh (100.0, 24)); // millimetres
  EXPECT_EQ (run ({"views", "truth", "result"}), 0);
  EXPECT_NE (errors_.find ("result/a/object_1.stl: the reconstruction is 1e+03 times as large"), std::string::npos)
      << errors_;
}

TEST_F (Evaluate, ComparesTheObjectsOfManyScenes)
{
  for (const char* folder : {"truth/a", "truth/b", "result/a", "result/b"})
    std::filesystem::create_directories (folder_.file (folder));
  save ("truth/a/truth_1.ply", sphereMesh (0.1, 24));
  save ("truth/a/truth_2.ply", sphereMesh (0.05, 24));
  writeFile (folder_.file ("truth/a/names.txt"), "1 blue ball\n2 marble\n");
  save ("truth/b/truth_7_melon.ply", sphereMesh (0.12, 24));
  save ("result/a/object_1.ply", sphereMesh (0.102, 24)); // 2 mm too large
  save ("result/b/object_7.ply", sphereMesh (0.14, 24));  // 20 mm too large; the marble is missing
  EXPECT_EQ (
      run ({"views", "--json", "v.json", "--csv", "v.csv", "--pictures", "worst", "--worst", "1", "truth", "result"}),
      0)
      << errors_;
  const nlohmann::json all = json ("v.json");
  ASSERT_EQ (all["objects"].size (), 3u);
  EXPECT_EQ (all["objects"][0]["name"], "blue ball");
  EXPECT_EQ (all["objects"][1]["name"], "marble");
  EXPECT_NEAR (all["objects"][0]["accuracy_m"], 0.002, 2e-4);
  EXPECT_EQ (all["objects"][0]["f_score_half"], 1.0);
  EXPECT_NEAR (all["objects"][0]["volume_ratio"], std::pow (1.02, 3.0), 1e-3);
  EXPECT_EQ (all["objects"][0]["gross"], false);
  EXPECT_EQ (all["objects"][1]["missing"], true);
  EXPECT_EQ (all["objects"][2]["name"], "melon");
  EXPECT_EQ (all["objects"][2]["f_score"], 0.0);
  EXPECT_EQ (all["summary"]["gross"], 2);
  EXPECT_EQ (all["summary"]["missing"], 1);
  EXPECT_EQ (all["summary"]["wrong_volume"], 1);
  EXPECT_NEAR (all["summary"]["f_score"], 1.0 / 3.0, 1e-9);
  EXPECT_NE (output_.find ("3 objects, 1 missing, 2 closed"), std::string::npos) << output_;
  EXPECT_NE (readFile (folder_.file ("v.csv")).find ("\nb,7,melon,0,"), std::string::npos);
  EXPECT_TRUE (std::filesystem::exists (folder_.file ("worst/01_b_7.png")));

  EXPECT_EQ (all.count ("expected_errors"), 0u); // these results have none

  TriangleMesh sure = sphereMesh (0.102, 24);
  sure.provenance.assign (sure.vertices.size (), 1);
  sure.sigma_m.assign (sure.vertices.size (), 0.0015f); // vertices are on the ball: 2 mm outside
  save ("result/a/object_1.ply", sure);
  save ("result/a/object_1_outer.ply", sphereMesh (0.13, 24));
  save ("result/b/object_7_outer.ply", sphereMesh (0.05, 24));
  EXPECT_EQ (run ({"views", "--json", "v.json", "truth", "result"}), 0) << errors_;
  const nlohmann::json certain = json ("v.json");
  EXPECT_EQ (certain["expected_errors"]["vertices"], sure.vertices.size ());
  EXPECT_EQ (certain["expected_errors"]["within_sigma"], 0.0);
  EXPECT_EQ (certain["expected_errors"]["within_two_sigma"], 1.0);
  EXPECT_EQ (certain["expected_errors"]["provenance"]["inferred"]["vertices"], sure.vertices.size ());
  EXPECT_EQ (certain["expected_errors"]["curve"].size (), 8u);
  EXPECT_EQ (certain["objects"][0]["inside_outer_bound"], 1.0);
  EXPECT_EQ (certain["objects"][2]["inside_outer_bound"], 0.0);
  EXPECT_NE (output_.find ("50.0 % of the truth is inside the outer bound"), std::string::npos) << output_;

  writeFile (folder_.file ("result/b/object_7.ply"), "no mesh");
  EXPECT_EQ (run ({"views", "truth", "result"}), 1);
  EXPECT_NE (errors_.find ("object_7.ply"), std::string::npos) << errors_;
  EXPECT_EQ (run ({"views", "result", "truth"}), 1);
  expectOneLine ("has no SCENE/truth_LABEL.ply");
  EXPECT_EQ (run ({"views", "nowhere", "result"}), 1);
  expectOneLine ("nowhere: cannot be read");
  EXPECT_EQ (run ({"views", "--gross", "0", "truth", "result"}), 2);
  expectOneLine ("--gross");
}
