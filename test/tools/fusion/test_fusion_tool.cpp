// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_fusion as its users call it: what it writes.

#include "fusion_scene.h"

#include "pcl_cosection/io/image_io.h"
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <nlohmann/json.hpp>

#include <filesystem>

#include <cmath>

#include <csignal>
#include <sys/resource.h>
#include <unistd.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace {

class FusionTool : public FusionScene
{
protected:
  /** \brief Every file that has its name can be read; others are temporary. */
  void expectWhole (const std::string& folder) const
  {
    if (!exists (folder))
      return;
    for (const std::string& name : filesIn (folder))
    {
      const std::string path = folder + "/" + name;
      const std::string extension = fs::path (name).extension ().string ();
      if (fs::path (name).filename ().string ().rfind (".cosection-", 0) == 0)
        continue;
      if (extension == ".ply")
        EXPECT_NO_THROW (loadPlyMesh (file (path))) << path;
      else if (extension == ".txt")
        EXPECT_NO_THROW (loadTrajectory (file (path))) << path;
      else
        EXPECT_NO_THROW (json (path)) << path;
    }
  }
};

const std::vector<std::string> all_files = {
    "mesh/background.ply",   "mesh/object_1.ply",       "mesh/object_1_tsdf.ply",
    "mesh/object_2.ply",     "mesh/object_2_tsdf.ply",  "summary.json",
    "trajectory/camera.txt", "trajectory/object_1.txt", "trajectory/object_2.txt"};

} // namespace

TEST_F (FusionTool, WritesMeshesTrajectoriesAndASummary)
{
  ASSERT_EQ (run (known ({"--json", "s.json", "sim", "out"})), 0) << errors_;
  EXPECT_EQ (errors_,
             "pcl_cosection_fusion: warning: object 2 of the masks has no trajectory: it is taken to be at rest\n");
  EXPECT_NE (output_.find ("wrote out: 12 frames, 2 keyframes, "), std::string::npos) << output_;
  EXPECT_EQ (filesIn ("out"), all_files);
  EXPECT_EQ (readFile (file ("s.json")), readFile (file ("out/summary.json")));
  const nlohmann::json summary = json ("s.json");
  EXPECT_EQ (summary["frames"], 12);
  EXPECT_EQ (summary["keyframes"], 2);
  EXPECT_EQ (summary["parameters"]["masks"], "sim/mask");
  for (const char* stage : {"read", "tracking", "integration", "raycast", "segmentation", "data_term", "constraints",
                            "solve", "mesh", "final_solve"})
    EXPECT_TRUE (summary["timings_s"].contains (stage)) << stage;
  EXPECT_GT (summary["timings_s"]["total"], 0.0);
  EXPECT_GT (summary["frames_per_second"], 0.0);
  EXPECT_EQ (summary["warnings"].size (), 1u);
  ASSERT_EQ (summary["objects"].size (), 2u);
  for (const auto& object : summary["objects"])
  {
    EXPECT_TRUE (object["closed"]);
    EXPECT_EQ (object["mask_ids"][0], object["id"]);
    EXPECT_EQ (object["frames_tracked"], 12);
    const TriangleMesh mesh = loadPlyMesh (
        file ("out/mesh/object_" + std::to_string (object["id"].get<int> ()) + ".ply"));
    EXPECT_EQ (mesh.vertices.size (), object["vertices"]);
    EXPECT_EQ (mesh.provenance.size (), mesh.vertices.size ());
  }
  // The ball's frame is at its centre.
  const TriangleMesh tsdf = loadPlyMesh (file ("out/mesh/object_1_tsdf.ply"));
  double sum = 0.0;
  for (const Eigen::Vector3f& vertex : tsdf.vertices)
    sum += std::abs (vertex.norm () - 0.1);
  EXPECT_LT (sum / static_cast<double> (tsdf.vertices.size ()), 0.01);
  const auto truth = loadTrajectory (file ("sim/gt-ball-1.txt")),
             written = loadTrajectory (file ("out/trajectory/object_1.txt"));
  ASSERT_EQ (truth.size (), written.size ());
  for (std::size_t n = 0; n < truth.size (); ++n)
    EXPECT_TRUE (truth[n].pose.isApprox (written[n].pose, 1e-6)) << n;
}

TEST_F (FusionTool, ItsOutputIsEvaluated)
{
  ASSERT_EQ (run (known ({"sim", "out"})), 0) << errors_;
  ToolRun evaluate ({"run", "out", "sim", "--json", "e.json", "--samples", "2000"}, file (""), {},
                    PCL_COSECTION_EVALUATE);
  ASSERT_EQ (evaluate.wait (), 0) << evaluate.errors ();
  const nlohmann::json result = json ("e.json");
  EXPECT_LT (result["camera"]["ate_rmse_m"], 1e-4);
  ASSERT_EQ (result["objects"].size (), 2u);
  EXPECT_TRUE (result["unmatched"].empty ());
  EXPECT_TRUE (result["missed"].empty ());
  for (const auto& object : result["objects"])
  {
    EXPECT_EQ (object["id"], object["truth_id"]);
    EXPECT_TRUE (object["closed"]);
    EXPECT_EQ (object["frames_tracked"], 12);
    EXPECT_LT (object["ate_rmse_m"], 0.01);
    EXPECT_LT (object["accuracy_m"], 0.02);
    EXPECT_LT (object["completeness_m"], 0.03);
  }
  EXPECT_LT (result["background"]["accuracy_m"], 0.03);
}

TEST_F (FusionTool, WithoutPosesEverythingIsTracked)
{
  for (int n = 0; n < 12; ++n)
    if (n % 5 != 0)
      fs::remove (file ("sim/mask/Mask" + std::string (n < 10 ? "000" : "00") + std::to_string (n) + ".png"));
  ASSERT_EQ (run ({"--masks", "sim/mask", "--background-voxel-size", "0.03", "sim", "out"}), 0) << errors_;
  EXPECT_EQ (filesIn ("out"), all_files);
  const nlohmann::json summary = json ("out/summary.json");
  for (const char* stage : {"read", "tracking", "segmentation", "integration", "final_solve"})
    EXPECT_GT (summary["timings_s"][stage], 0.0) << stage;
  int begun = 0;
  for (const std::string event : summary["events"]) // others are of volumes that grow
  {
    begun += event.find (" begins ") != std::string::npos;
    EXPECT_EQ (event.find ("lost"), std::string::npos) << event;
    EXPECT_EQ (event.find ("given up"), std::string::npos) << event;
  }
  EXPECT_EQ (begun, 2);
  ASSERT_EQ (summary["objects"].size (), 2u);
  for (const auto& object : summary["objects"])
  {
    EXPECT_EQ (object["frames_tracked"], 12);
    EXPECT_TRUE (object["mask_ids"].empty ());
  }
  EXPECT_EQ (loadTrajectory (file ("out/trajectory/camera.txt")).size (), 12u);
  EXPECT_TRUE (loadTrajectory (file ("out/trajectory/camera.txt"))[0].pose.isApprox (Eigen::Isometry3d::Identity ()));
}

TEST_F (FusionTool, ThreadsDoNotMatter)
{
  for (const char* threads : {"1", "2"})
    ASSERT_EQ (run (known ({"--threads", threads, "--save-keyframes", "--deterministic", "--keyframe-every", "6", "sim",
                            threads})),
               0)
        << errors_;
  const Words files = filesIn ("1");
  EXPECT_EQ (files, filesIn ("2"));
  EXPECT_EQ (std::count (files.begin (), files.end (), "keyframes/6/object_2.ply"), 1);
  for (const std::string& name : files)
    if (name != "summary.json")
    {
      EXPECT_EQ (readFile (file ("1/" + name)), readFile (file ("2/" + name))) << name;
    }
}

TEST_F (FusionTool, UpdatesBesideTheFrontEndChangeNoResult)
{
  ASSERT_EQ (run (known ({"sim", "without"})), 0) << errors_;
  ASSERT_EQ (run (known ({"--save-keyframes", "--keyframe-every", "10", "sim", "with"})), 0) << errors_;
  EXPECT_TRUE (exists ("with/keyframes/10/object_1.ply")) << "the last is always completed";
  EXPECT_GT (json ("with/summary.json")["timings_s"]["updates"], 0.0);
  for (const std::string& name : filesIn ("without"))
    if (name != "summary.json")
    {
      EXPECT_EQ (readFile (file ("with/" + name)), readFile (file ("without/" + name))) << name;
    }
}

TEST_F (FusionTool, WhatAnEarlierRunWroteIsReplaced)
{
  ASSERT_EQ (run (known ({"--save-keyframes", "--deterministic", "--keyframe-every", "6", "sim", "out"})), 0)
      << errors_;
  EXPECT_TRUE (exists ("out/keyframes/0/background.ply"));
  writeFile (file ("out/notes.txt"), "mine");
  writeFile (file ("out/mesh/mine.ply"), "mine");
  writeFile (file ("out/mesh/.cosection-123-0.tmp.ply"), "killed");
  writeFile (file ("out/mesh/object_7.ply"), "of another run");

  // A slip of the pen costs nothing.
  expectFailure ({"--camera-trajectory", "sim/gt-cam-O.txt", "sim", "out"}, 1, "sim/gt-cam-O.txt");
  EXPECT_TRUE (exists ("out/mesh/object_1.ply"));
  EXPECT_TRUE (exists ("out/keyframes/6/object_1.ply"));

  ASSERT_EQ (run ({"--camera-trajectory", "sim/gt-cam-0.txt", "--frames", "3:4", "sim", "out"}), 0) << errors_;
  EXPECT_EQ (filesIn ("out"),
             (Words{"mesh/background.ply", "mesh/mine.ply", "notes.txt", "summary.json", "trajectory/camera.txt"}));
  EXPECT_FALSE (exists ("out/keyframes"));
}

TEST_F (FusionTool, ConstraintsPresetsAndConfigurationsAreFollowed)
{
  for (const char* constraints : {"none", "hull", "intersection", "all"})
  {
    ASSERT_EQ (run (known ({"--constraints", constraints, "--resolution", "16", "sim", "out"})), 0) << errors_;
    EXPECT_EQ (json ("out/summary.json")["parameters"]["constraints"], constraints);
  }
  writeFile (file ("my.ini"),
             "keyframe-every = 4\nmasks = \"sim/mask\"\nframes = \"0:9\"\nvoxel-size = 0.01\nquiet = true\n");
  ASSERT_EQ (run ({"--config", "my.ini", "--camera-trajectory", "sim/gt-cam-0.txt", "--max-views", "5", "sim", "out"}),
             0)
      << errors_;
  EXPECT_EQ (output_ + errors_, "");
  const nlohmann::json summary = json ("out/summary.json");
  EXPECT_EQ (summary["keyframes"], 3);
  EXPECT_EQ (summary["frames"], 9);
  EXPECT_EQ (summary["parameters"]["max_views"], 5);
  EXPECT_DOUBLE_EQ (summary["objects"][0]["voxel_size_m"], 0.01);
  ASSERT_EQ (run (known ({"--preset", "paper", "--resolution", "16", "sim", "out"})), 0) << errors_;
  EXPECT_EQ (json ("out/summary.json")["parameters"]["weighting"], "sum");
}

TEST_F (FusionTool, MasksOfSixteenBits)
{
  fs::create_directory (file ("wide"));
  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
  {
    Image<std::uint16_t> mask = loadMaskImage (entry.path ().string ());
    for (std::uint16_t& pixel : mask.pixels)
      pixel = static_cast<std::uint16_t> (pixel == 0 ? 0 : 65532 + pixel);
    saveMaskImage (mask, file ("wide/" + entry.path ().filename ().string ()), true);
  }
  ASSERT_EQ (run ({"--camera-trajectory", "sim/gt-cam-0.txt", "--masks", "wide", "--object-trajectory",
                   "65533=sim/gt-ball-1.txt", "--resolution", "16", "sim", "out"}),
             0)
      << errors_;
  EXPECT_TRUE (exists ("out/mesh/object_65533.ply"));
  EXPECT_TRUE (exists ("out/mesh/object_65534_tsdf.ply")); // 65535 is no object
}

TEST_F (FusionTool, MasksOfWhichTheBackgroundIsAnObjectAreWarnedOf)
{
  const std::string warning = "masks must be 0 where no object is";
  fs::create_directory (file ("shifted"));
  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
  {
    Image<std::uint16_t> mask = loadMaskImage (entry.path ().string ());
    for (std::uint16_t& pixel : mask.pixels)
      ++pixel;
    saveMaskImage (mask, file ("shifted/" + entry.path ().filename ().string ()), true);
  }
  ASSERT_EQ (run ({"--camera-trajectory", "sim/gt-cam-0.txt", "--masks", "shifted", "--object-trajectory",
                   "2=sim/gt-ball-1.txt", "--resolution", "16", "sim", "out"}),
             0)
      << errors_;
  EXPECT_NE (errors_.find ("object 1 extends farther than all others together: " + warning), std::string::npos)
      << errors_;
  ASSERT_EQ (run (known ({"--resolution", "16", "sim", "out"})), 0) << errors_;
  EXPECT_EQ (errors_.find (warning), std::string::npos) << errors_;
}

TEST_F (FusionTool, ALayoutWithPosesNeedsNoTrajectory)
{
  fs::create_directory (file ("seven"));
  for (const StampedPose& pose : loadTrajectory (file ("sim/gt-cam-0.txt")))
  {
    const std::string digits = std::to_string (1000000 + static_cast<int> (pose.stamp)).substr (1);
    fs::copy (file ("sim/depth_noise/Depth" + digits.substr (2) + ".png"),
              file ("seven/frame-" + digits + ".depth.png"));
    std::ofstream (file ("seven/frame-" + digits + ".pose.txt")) << pose.pose.matrix () << '\n';
  }
  fs::copy (file ("sim/calibration.txt"), file ("seven/calibration.txt"));
  ASSERT_EQ (run ({"seven", "out"}), 0) << errors_;
  EXPECT_EQ (json ("out/summary.json")["frames"], 12);
  EXPECT_TRUE (exists ("out/mesh/background.ply"));
}

TEST_F (FusionTool, AnInterruptionLeavesWholeFiles)
{
  ToolRun tool (known ({"--save-keyframes", "--keyframe-every", "2", "--verbose", "sim", "out"}), file (""), {},
                PCL_COSECTION_FUSION);
  EXPECT_TRUE (tool.waitForError ("keyframe"));
  tool.send (SIGINT);
  EXPECT_EQ (tool.wait (), 130);
  EXPECT_NE (tool.errors ().find ("error: interrupted; what was written is whole\n"), std::string::npos)
      << tool.errors ();
  EXPECT_FALSE (exists ("out/summary.json"));
  expectWhole ("out");
}

TEST_F (FusionTool, AKilledRunLeavesWholeFilesAndTheNextCleansUp)
{
  for (const int delay_ms : {60, 150, 300, 500, 700})
  {
    ToolRun tool (known ({"--save-keyframes", "--keyframe-every", "2", "--quiet", "sim", "out"}), file (""), {},
                  PCL_COSECTION_FUSION);
    ::usleep (1000 * delay_ms);
    tool.send (SIGKILL);
    tool.wait ();
    expectWhole ("out");
  }
  ASSERT_EQ (run (known ({"sim", "out"})), 0) << errors_;
  EXPECT_EQ (filesIn ("out"), all_files);
}

TEST_F (FusionTool, AFullDiskIsAnErrorAndLeavesWholeFiles)
{
  const auto smallFiles = [] {
    const rlimit limit{20000, 20000};
    setrlimit (RLIMIT_FSIZE, &limit);
    std::signal (SIGXFSZ, SIG_IGN);
  };
  EXPECT_EQ (run (known ({"--voxel-size", "0.006", "sim", "out"}), smallFiles), 1);
  EXPECT_NE (errors_.find ("error: "), std::string::npos);
  EXPECT_NE (errors_.find ("out/mesh/"), std::string::npos) << errors_;
  expectWhole ("out");
  for (const std::string& name : filesIn ("out"))
    EXPECT_EQ (name.find (".tmp"), std::string::npos) << name;
  EXPECT_TRUE (json ("out/summary.json").contains ("error"));
}
