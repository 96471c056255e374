// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fused_scene.h"

#include <cstdlib>
#include <memory>

namespace fs = std::filesystem;
using namespace pcl::cosection::test;

namespace {

std::unique_ptr<TemporaryFolder> fused; // lives as long as the program

} // namespace

void
FusedScene::SetUpTestSuite ()
{
  FusionScene::SetUpTestSuite ();
  if (fused)
    return;
  struct Maker : FusedScene
  {
    void TestBody () override {}

    void make ()
    {
      ASSERT_EQ (run (known ({"sim", "out"})), 0) << errors_;
      fused = std::make_unique<TemporaryFolder> ();
      fs::copy (file ("out"), fused->file ("out"), fs::copy_options::recursive);
    }
  };
  Maker ().make ();
}

FusedScene::FusedScene ()
{
  if (fused)
    fs::copy (fused->file ("out"), file ("out"), fs::copy_options::recursive);
}

int
FusedScene::view (const Words& arguments, const std::function<void ()>& prepare)
{
  const auto without_display = [] { unsetenv ("DISPLAY"); };
  return (run (arguments, prepare ? prepare : without_display, PCL_COSECTION_VIEWER));
}

void
FusedScene::expectNoView (const Words& arguments, int status, const std::string& part)
{
  EXPECT_EQ (view (arguments), status) << part << '\n' << errors_;
  expectErrorLine (errors_, "pcl_cosection_viewer", part);
  EXPECT_EQ (output_, "");
}

std::map<std::string, std::pair<std::string, fs::file_time_type>>
FusedScene::snapshot (const std::string& folder) const
{
  std::map<std::string, std::pair<std::string, fs::file_time_type>> files;
  for (const auto& entry : fs::recursive_directory_iterator (file (folder)))
    files[fs::relative (entry.path (), file (folder)).string ()] = {
        entry.is_regular_file () ? readFile (entry.path ().string ()) : "", entry.last_write_time ()};
  return (files);
}
