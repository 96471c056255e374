// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_fusion with wrong arguments and damaged data: what it says, and what it leaves alone.

#include "fusion_command_line.h"
#include "fusion_scene.h"
#include "segmentation/spot_network.h"

#include "pcl_cosection/io/image_io.h"
#include <pcl/cosection/io/trajectory.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

using namespace pcl::cosection;
using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace {

class FusionToolErrors : public FusionScene
{
protected:
  static Words camera (const std::string& trajectory, Words more = {})
  {
    Words words = {"--camera-trajectory", trajectory};
    words.insert (words.end (), more.begin (), more.end ());
    return (words);
  }

  /** \brief Write a trajectory whose line \a number is another. */
  void withLine (std::size_t number, const std::string& line, const std::string& name) const
  {
    std::istringstream in (readFile (file ("sim/gt-cam-0.txt")));
    std::string text, each;
    for (std::size_t n = 1; std::getline (in, each); ++n)
      text += (n == number ? line : each) + "\n";
    writeFile (file (name), text);
  }

  template <typename Change> void changeMasks (Change&& change) const
  {
    for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
    {
      Image<std::uint16_t> mask = loadMaskImage (entry.path ().string ());
      change (mask, entry.path ().stem ().string ());
      saveMaskImage (mask, entry.path ().string (), true);
    }
  }

  template <typename Change> void changeDepths (Change&& change) const
  {
    for (const auto& entry : fs::directory_iterator (file ("sim/depth_noise")))
      change (entry.path ().string ());
  }
};

} // namespace

TEST_F (FusionToolErrors, WrongUsage)
{
  expectFailure ({}, 2, "DATASET and OUTPUT are missing");
  expectFailure ({"sim"}, 2, "OUTPUT is missing after sim");
  expectFailure ({"sim", "out", "more"}, 2, "one argument too many: more");
  expectFailure ({"sim", ""}, 2, "OUTPUT is empty");
  expectFailure ({"--mask", "sim/mask", "sim", "out"}, 2, "did you mean --masks?");
  for (const char* frames : {"3", "a:b", "3:2", "5:5", "-1:2", "1:2:3", "1.5:2"})
    expectFailure ({"--frames", frames, "sim", "out"}, 2, "--frames");
  expectFailure ({"--intrinsics", "1,2,3", "sim", "out"}, 2, "--intrinsics must be four numbers");
  expectFailure ({"--intrinsics", "100,-100,60,45", "sim", "out"}, 2, "positive fx and fy");
  expectFailure ({"--intrinsics", "100,100,60,-1e308", "sim", "out"}, 2, "it must be in the image, or near it");
  expectFailure ({"--keyframe-every", "0", "sim", "out"}, 2, "--keyframe-every");
  expectFailure ({"--max-views", "3", "sim", "out"}, 2, "--max-views");
  expectFailure ({"--max-depth", "0", "sim", "out"}, 2, "--max-depth");
  expectFailure ({"--format", "kitti", "sim", "out"}, 2, "cofusion");
  expectFailure ({"--voxel-size", "0.01", "--resolution", "64", "sim", "out"}, 2, "exclude each other");
  expectFailure ({"--object-trajectory", "1=sim/gt-ball-1.txt", "sim", "out"}, 2, "needs --masks");
  expectFailure ({"--masks", "sim/mask", "--object-trajectory", "ball=sim/gt-ball-1.txt", "sim", "out"}, 2,
                 "must be ID=FILE");
  expectFailure ({"--mask-ids", "persistent", "sim", "out"}, 2, "--mask-ids needs --masks");
  expectFailure (
      {"--masks", "sim/mask", "--mask-ids", "per-frame", "--object-trajectory", "1=sim/gt-ball-1.txt", "sim", "out"}, 2,
      "not --mask-ids per-frame");
  EXPECT_FALSE (exists ("out"));
}

TEST_F (FusionToolErrors, WhatIsNotThere)
{
  expectFailure ({"--masks", "sim/mask", "--object-trajectory", "1=sim/gt-ball-1.txt", "sim", "out"}, 1,
                 "--object-trajectory needs the poses of the camera: sim has none; give --camera-trajectory FILE");
  expectFailure (camera ("sim/gt-cam-0.txt", {"--masks", "sim/mask", "--mask-ids", "per-frame", "sim", "out"}), 1,
                 "with given poses, objects must have the same number in all masks");
  expectFailure (camera ("sim/gt-cam-0.txt", {"nowhere", "out"}), 1, "nowhere: there is no such folder");
  expectFailure (camera ("nowhere.txt", {"sim", "out"}), 1, "nowhere.txt");
  expectFailure (camera ("sim/gt-cam-0.txt", {"--masks", "nowhere", "sim", "out"}), 1,
                 "nowhere: there is no such folder");
  expectFailure (
      camera ("sim/gt-cam-0.txt", {"--masks", "sim/mask", "--object-trajectory", "1=nowhere.txt", "sim", "out"}), 1,
      "nowhere.txt");
  expectFailure (camera ("sim/gt-cam-0.txt", {"--depth-dir", "dept", "sim", "out"}), 1,
                 "sim/dept: there is no such folder");
  fs::create_directory (file ("empty"));
  expectFailure (camera ("sim/gt-cam-0.txt", {"empty", "out"}), 1, "empty: is an empty folder");
  expectFailure (camera ("sim/gt-cam-0.txt", {"--masks", "empty", "sim", "out"}), 1, "empty: has no masks");
  expectFailure (camera ("sim/gt-cam-0.txt", {"--frames", "12:", "sim", "out"}), 1,
                 "the frames from 12 on are not there; the sequence has 0:12");
  fs::remove (file ("sim/calibration.txt"));
  expectFailure (known ({"sim", "out"}), 1, "sim: has no calibration.txt");
  EXPECT_FALSE (exists ("out"));
}

TEST_F (FusionToolErrors, Trajectories)
{
  withLine (4, "3 0 0 0 1", "short.txt");
  expectFailure (camera ("short.txt", {"sim", "out"}), 1, "short.txt: line 4: has 5 numbers; a pose is");
  withLine (2, "1 0 0 0 0 0 0 0", "zero.txt");
  expectFailure (camera ("zero.txt", {"sim", "out"}), 1,
                 "zero.txt: line 2: has a quaternion qx qy qz qw of length zero");
  withLine (5, "3 0 0 0 0 0 0 1", "twice.txt");
  expectFailure (camera ("twice.txt", {"sim", "out"}), 1, "twice.txt: has two poses of stamp 3");
  writeFile (file ("empty.txt"), "# nothing\n");
  expectFailure (camera ("empty.txt", {"sim", "out"}), 1, "empty.txt: has no poses");

  std::vector<StampedPose> poses = loadTrajectory (file ("sim/gt-cam-0.txt"));
  for (StampedPose& pose : poses)
    pose.stamp += 1000.0;
  saveTrajectory (poses, file ("later.txt"));
  expectFailure (camera ("later.txt", {"sim", "out"}), 1, "its stamps are 1000 to 1011, those of the frames 0 to 11");
  EXPECT_FALSE (exists ("out"));

  for (StampedPose& pose : poses)
    pose.stamp -= 992.0; // begins at the eighth frame
  saveTrajectory (poses, file ("late.txt"));
  expectFailure (camera ("late.txt", {"sim", "out"}), 1,
                 "most frames were left out: 8 of 12; what was written is of the others alone; the poses of late.txt "
                 "have the stamps 8 to 19, the frames 0 to 11; they must be within half a frame of each other");
  EXPECT_NE (errors_.find ("warning: 8 of 12 frames were left out"), std::string::npos) << errors_;
  EXPECT_EQ (loadTrajectory (file ("out/trajectory/camera.txt")).size (), 4u);

  for (StampedPose& pose : poses)
    pose.stamp -= 3.0; // begins at the fifth frame
  saveTrajectory (poses, file ("half.txt"));
  EXPECT_EQ (run (camera ("half.txt", {"sim", "out"})), 0) << errors_;
  EXPECT_NE (errors_.find ("warning: 5 of 12 frames were left out"), std::string::npos) << errors_;

  // Seconds, where the frames have numbers: it does not seem to be another unit, though the camera moves far between
  // the few frames that have a pose.
  for (std::size_t n = 0; n < poses.size (); ++n)
  {
    poses[n].stamp = static_cast<double> (n) / 10.0;
    poses[n].pose.translation () *= 5.0;
  }
  saveTrajectory (poses, file ("seconds.txt"));
  expectFailure (
      camera ("seconds.txt", {"sim", "seconds"}), 1,
      "most frames were left out: 10 of 12; what was written is of the others alone; the poses of seconds.txt "
      "have the stamps 0 to 1.1, the frames 0 to 11");
}

TEST_F (FusionToolErrors, PosesInMillimetresAreRefusedBeforeAnythingIsSolved)
{
  std::vector<StampedPose> poses = loadTrajectory (file ("sim/gt-cam-0.txt"));
  for (StampedPose& pose : poses)
    pose.pose.translation () *= 1000.0;
  saveTrajectory (poses, file ("mm.txt"));
  expectFailure (camera ("mm.txt", {"sim", "out"}), 1, "mm.txt: from frame to frame the camera would move ");
  EXPECT_NE (errors_.find ("divide their positions by 1000 if they are in millimetres"), std::string::npos) << errors_;
  EXPECT_FALSE (exists ("out"));
}

TEST_F (FusionToolErrors, InputsAreNotOverwritten)
{
  for (const char* output : {"sim", ".", "..", "sim/mask", "sim/../sim"})
    expectFailure (known ({"sim", output}), 2, "would overwrite the input");
  fs::create_directory_symlink ("sim", file ("link"));
  expectFailure (known ({"sim", "link"}), 2, "would overwrite the input");
  const std::string before = readFile (file ("sim/gt-cam-0.txt"));
  expectFailure (known ({"--json", "sim/gt-cam-0.txt", "sim", "out"}), 2, "would be overwritten: it is an input");
  expectFailure (known ({"--json", "sim/calibration.txt", "sim", "out"}), 2,
                 "would be overwritten: it is part of the input sim");
  expectFailure (known ({"--json", "sim/mask/Mask0003.png", "sim", "out"}), 2, "would be overwritten");
  expectFailure (known ({"--json", "out/mesh/object_1.ply", "sim", "out"}), 2, "is where the run writes other files");
  EXPECT_EQ (readFile (file ("sim/gt-cam-0.txt")), before);
  EXPECT_FALSE (exists ("out"));
}

TEST_F (FusionToolErrors, OutputsThatCannotBe)
{
  writeFile (file ("file"), "mine");
  expectFailure (known ({"sim", "file"}), 1, "file: is a file; OUTPUT must be a folder");
  expectFailure (known ({"sim", "file/out"}), 1, "file/out: the folder cannot be made");
  expectFailure (known ({"sim", "/proc/out"}), 1, "/proc/out: the folder cannot be made");
  expectFailure (known ({"--json", "nowhere/s.json", "sim", "out"}), 1, "nowhere/s.json: cannot be written");
  EXPECT_FALSE (exists ("out"));
  EXPECT_EQ (readFile (file ("file")), "mine");
  EXPECT_EQ (run (known ({"--frames", ":2", "--json", "new/s.json", "sim", "new"})), 0) << errors_;
  EXPECT_TRUE (exists ("new/s.json"));
}

TEST_F (FusionToolErrors, AFailureIsInTheSummary)
{
  expectFailure ({"--camera-trajectory", "no.txt", "--json", "s.json", "sim", "out"}, 1, "no.txt");
  EXPECT_NE (json ("s.json")["error"].get<std::string> ().find ("no.txt"), std::string::npos);
  changeDepths ([] (const std::string& path) { writeFile (path, "damaged"); });
  expectFailure (known ({"--json", "s.json", "sim", "out"}), 1,
                 "no frame can be read: sim/depth_noise/Depth0000.png: is not an image");
  EXPECT_EQ (errors_.find ("the frame is skipped"), std::string::npos) << errors_;
  for (const char* name : {"s.json", "out/summary.json"})
    EXPECT_NE (nlohmann::json::parse (readFile (file (name)))["error"].get<std::string> ().find ("Depth0000"),
               std::string::npos);
}

TEST_F (FusionToolErrors, DamagedFramesAreSkippedAndTold)
{
  const std::string bytes = readFile (file ("sim/depth_noise/Depth0000.png"));
  writeFile (file ("sim/depth_noise/Depth0000.png"), bytes.substr (0, bytes.size () / 2));
  writeFile (file ("sim/depth_noise/Depth0003.png"), "");
  saveDepthImage (Image<float> (20, 20, 1.0f), file ("sim/depth_noise/Depth0005.png"));
  fs::remove (file ("sim/depth_noise/Depth0007.png"));
  writeFile (file ("sim/mask/Mask0001.png"), bytes.substr (0, 60));
  fs::remove (file ("sim/mask/Mask0002.png"));
  EXPECT_EQ (run (known ({"--keyframe-every", "4", "sim", "out"})), 0) << errors_;
  for (const char* part :
       {"Depth0000.png: is damaged: the file is cut short, or a checksum does not match; the frame is skipped",
        "Depth0003.png: is empty", "Depth0005.png: has 20 x 20 pixels, but sim/calibration.txt has 120 x 90 pixels",
        "frames are missing after", "Mask0001.png: is damaged"})
    EXPECT_NE (errors_.find (part), std::string::npos) << part << '\n' << errors_;
  const auto summary = json ("out/summary.json");
  EXPECT_EQ (summary["frames"], 8);
  EXPECT_EQ (summary["objects"].size (), 2u);
}

TEST_F (FusionToolErrors, DepthsOfAnotherUnitAreNoResult)
{
  expectFailure (
      known ({"--depth-scale", "1", "sim", "out"}), 1,
      "no keyframe has a surface nearer than 10 m: sim/depth_noise/Depth0000.png: half of the depths are more than ");
  EXPECT_TRUE (filesIn ("out") == Words{"summary.json"});
  changeDepths ([] (const std::string& path) {
    Image<float> depth = loadDepthImage (path);
    saveDepthImage (Image<float> (depth.width, depth.height, 0.0f), path);
  });
  expectFailure (known ({"sim", "out"}), 1, "Depth0000.png: has no depth in any pixel");
}

TEST_F (FusionToolErrors, WithoutPosesNoFrameLacksOne)
{
  expectFailure ({"--max-depth", "0.1", "sim", "out"}, 1,
                 "no reading is nearer than --max-depth 0.1 m: the nearest is 0.");
  changeDepths ([] (const std::string& path) { saveDepthImage (Image<float> (120, 90, 0.0f), path); });
  expectFailure ({"sim", "out"}, 1,
                 "the camera could not be tracked in any frame: sim/depth_noise/Depth0000.png: has no depth in any "
                 "pixel");
}

TEST_F (FusionToolErrors, MasksOfAnotherSizeOrWithoutFrames)
{
  fs::copy (file ("sim/mask"), file ("far"));
  for (const auto& entry : fs::directory_iterator (file ("sim/mask")))
    fs::rename (file ("far/" + entry.path ().filename ().string ()),
                file ("far/9" + entry.path ().filename ().string ().substr (4)));
  expectFailure (camera ("sim/gt-cam-0.txt", {"--masks", "far", "sim", "out"}), 1,
                 "far: no mask matches a frame; the masks have the stamps 90000 to 90011, the frames 0 to 11");
  changeMasks ([] (Image<std::uint16_t>& mask, const std::string&) { mask = Image<std::uint16_t> (60, 50, 1); });
  expectFailure (known ({"sim", "out"}), 1,
                 "no frame has a mask that can be used: sim/mask/Mask0000.png: has 60 x 50 pixels");
  EXPECT_EQ (errors_.find ("the frame is used"), std::string::npos) << errors_;
}

TEST_F (FusionToolErrors, OddObjects)
{
  // One keyframe has the ball; a few outlier pixels are no object.
  changeMasks ([] (Image<std::uint16_t>& mask, const std::string& name) {
    std::replace (mask.pixels.begin (), mask.pixels.end (), std::uint16_t (1),
                  std::uint16_t (name == "Mask0000" ? 1 : 0));
    for (int v = 80; v < 84; ++v)
      for (int u = 20; u < 28; ++u)
        mask.at (u, v) = 400;
  });
  EXPECT_EQ (run (known ({"--object-trajectory", "9=sim/gt-box-2.txt", "sim", "out"})), 0) << errors_;
  EXPECT_NE (errors_.find ("object 400 was left out: it has only "), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("object 9 has a trajectory, but no points in any keyframe"), std::string::npos) << errors_;
  EXPECT_FALSE (exists ("out/mesh/object_400_tsdf.ply"));
  EXPECT_FALSE (exists ("out/trajectory/object_9.txt"));
  EXPECT_TRUE (exists ("out/mesh/object_1.ply"));
  EXPECT_TRUE (exists ("out/mesh/object_2.ply"));
}

TEST_F (FusionToolErrors, OneBadObjectDoesNotLoseTheRest)
{
  expectFailure (known ({"--voxel-size", "0.15", "sim", "out"}), 1,
                 "object 2: voxel size 0.15 m is larger than the object");
  EXPECT_TRUE (exists ("out/mesh/background.ply"));
  EXPECT_TRUE (exists ("out/mesh/object_1.ply"));
  const auto summary = json ("out/summary.json");
  ASSERT_EQ (summary["failed"].size (), 1u);
  EXPECT_EQ (summary["failed"][0]["id"], 2);
  expectFailure (camera ("sim/gt-cam-0.txt", {"--max-memory", "5M", "sim", "out"}), 1, "nothing could be completed; ");
}

/** \brief Those of --help. */
TEST_F (FusionToolErrors, TheExamplesWork)
{
  fs::create_directory (file ("toys"));
  for (const auto& entry : fs::directory_iterator (file ("sim")))
    fs::rename (entry.path (), file ("toys/" + entry.path ().filename ().string ()));
  for (const char* name : {"truck-1", "car-2"})
    fs::copy (file ("toys/gt-ball-1.txt"), file ("toys/gt-" + std::string (name) + ".txt"));
  std::ofstream options (file ("toys.txt"));
  for (const std::string& line : fusionText ().configuration)
    options << line << std::endl;
  for (const char* name : {"sequence", "kitchen", "masks"})
    fs::create_directory_symlink (std::string (name) == "masks" ? "toys/mask" : "toys", file (name));
  fs::copy (file ("toys/gt-cam-0.txt"), file ("toys/groundtruth.txt"));
  fs::copy (file ("toys/gt-cam-0.txt"), file ("cam.txt"));
  std::ofstream (file ("net.onnx"), std::ios::binary)
      << affineOnnx (24, 18, colourNetwork (24, 18, {{1, -1, 0}, {-1, 0, 1}}, 0.15f));
  for (const UsageExample& example : fusionText ().examples)
  {
    std::istringstream in (example.command);
    Words words{std::istream_iterator<std::string> (in), {}};
    ASSERT_EQ (words.front (), "pcl_cosection_fusion");
    words.erase (words.begin ());
    if (std::find (words.begin (), words.end (), "--model") != words.end ())
      words.insert (words.begin (), {"--input-size", "24,18"}); // this network is smaller than a reader's
    EXPECT_EQ (run (words), 0) << example.command << '\n' << errors_;
    EXPECT_TRUE (exists (words.back () + "/mesh/background.ply")) << example.command;
    fs::remove_all (file (words.back ()));
  }
}
