// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_scene.h"

#include "fusion/ball_and_box.h"

#include <memory>

namespace fs = std::filesystem;
using namespace pcl::cosection::test;

namespace {

std::unique_ptr<TemporaryFolder> rendered; // lives as long as the program

} // namespace

void
FusionScene::SetUpTestSuite ()
{
  if (rendered)
    return;
  rendered = std::make_unique<TemporaryFolder> ();
  std::ofstream (rendered->file ("scene.json")) << sceneJson (12, 120, 90, 0.4);
  ToolRun run ({"scene.json", "sim"}, rendered->file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (run.wait (), 0) << run.errors ();
}

FusionScene::FusionScene () : ToolTest (PCL_COSECTION_FUSION)
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
