// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_scene.h"

#include <memory>

namespace fs = std::filesystem;
using namespace pcl::cosection::test;

namespace {

const char* const coarse_scene = R"({
  "frames": 12,
  "camera": {"width": 120, "height": 90, "keys": [
    {"time": 0, "position": [-0.3, -0.7, 0.45], "look_at": [0, 0, 0.05]},
    {"time": 0.4, "position": [0.3, -0.7, 0.5], "look_at": [0, 0, 0.05]}]},
  "background": {"parts": [{"type": "plane", "extent": 1}]},
  "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "colour": [200, 60, 40],
     "keys": [{"time": 0, "position": [-0.15, 0, 0.1]}, {"time": 0.4, "position": [-0.15, 0.1, 0.1]}]},
    {"name": "box", "shape": {"type": "box", "size": [0.16, 0.12, 0.1]}, "keys": [{"position": [0.12, 0, 0.05]}]}]
})";

std::unique_ptr<TemporaryFolder> rendered; // lives as long as the program

} // namespace

void
FusionScene::SetUpTestSuite ()
{
  if (rendered)
    return;
  rendered = std::make_unique<TemporaryFolder> ();
  std::ofstream (rendered->file ("scene.json")) << coarse_scene;
  ToolRun run ({"scene.json", "sim"}, rendered->file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (run.wait (), 0) << run.errors ();
}

FusionScene::FusionScene ()
{
  fs::copy (rendered->file ("sim"), file ("sim"), fs::copy_options::recursive);
}

FusionScene::Words
FusionScene::known (Words more)
{
  Words words = {"--camera-trajectory", "sim/gt-cam-0.txt",        "--masks", "sim/mask", "--object-trajectory",
                 "1=sim/gt-ball-1.txt", "--background-voxel-size", "0.03"};
  words.insert (words.end (), more.begin (), more.end ());
  return (words);
}

int
FusionScene::run (const Words& arguments, const std::function<void ()>& prepare)
{
  ToolRun tool (arguments, file (""), prepare, PCL_COSECTION_FUSION);
  const int status = tool.wait ();
  output_ = tool.output ();
  errors_ = tool.errors ();
  return (status);
}

void
FusionScene::expectFailure (const Words& arguments, int status, const std::string& part)
{
  EXPECT_EQ (run (arguments), status) << part << '\n' << errors_;
  const std::size_t error = errors_.find ("pcl_cosection_fusion: error: ");
  ASSERT_NE (error, std::string::npos) << errors_;
  EXPECT_EQ (std::count (errors_.begin () + static_cast<std::ptrdiff_t> (error), errors_.end (), '\n'), 1) << errors_;
  EXPECT_NE (errors_.find (part, error), std::string::npos) << errors_;
}

FusionScene::Words
FusionScene::filesIn (const std::string& folder) const
{
  Words names;
  for (const auto& entry : fs::recursive_directory_iterator (file (folder)))
    if (entry.is_regular_file ())
      names.push_back (fs::relative (entry.path (), file (folder)).string ());
  std::sort (names.begin (), names.end ());
  return (names);
}
