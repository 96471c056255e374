// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with the clouds of PCL's own tests, which are no labelled views.

#include "common/data_folder.h"
#include "common/temporary_folder.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

struct Expected
{
  const char* file;
  double least_m3, most_m3; ///< volume of the mesh
  const char* warning;      ///< empty: none
};

class PclClouds : public testing::TestWithParam<Expected>
{};

} // namespace

TEST_P (PclClouds, GiveASensibleMesh)
{
  const fs::path cloud = dataFolder ("pcl") / GetParam ().file;
  if (!fs::exists (cloud))
    GTEST_SKIP () << "there is no " << cloud;
  const pcl::cosection::test::TemporaryFolder folder;
  ToolRun run ({cloud.string (), "out.ply"}, folder.file (""));
  ASSERT_EQ (run.wait (), 0) << run.errors ();
  const std::string errors = run.errors ();
  if (*GetParam ().warning)
    EXPECT_NE (errors.find (GetParam ().warning), std::string::npos) << errors;
  else
    EXPECT_EQ (errors, "");
  const TriangleMesh mesh = loadPlyMesh (folder.file ("out.ply"));
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  const double volume = computeMassProperties (mesh).volume_m3;
  EXPECT_GE (volume, GetParam ().least_m3);
  EXPECT_LE (volume, GetParam ().most_m3);
}

// The bunny has three quarters of a litre, and only its right side was scanned; the carton holds one litre, and is cut
// out with some of what stands behind it. The scenes are taken as one object: table and all.
INSTANTIATE_TEST_SUITE_P (
    Clouds, PclClouds,
    testing::Values (Expected{"bun0.pcd", 0.0005, 0.0015, "point inward; they were turned"},
                     Expected{"bunny.pcd", 0.0005, 0.0015, "is not known"}, Expected{"milk.pcd", 0.0012, 0.0030, ""},
                     Expected{"milk_cartoon_all_small_clorox.pcd", 0.05, 1.5, "has no field label"},
                     Expected{"table_scene_mug_stereo_textured.pcd", 0.02, 0.5, "has no field label"}),
    [] (const auto& info) {
      std::string name = fs::path (info.param.file).stem ().string ();
      return (name);
    });
