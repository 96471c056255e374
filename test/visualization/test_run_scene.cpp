// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "run_folder.h"

#include "common/message_of.h"
#include "common/small_meshes.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <gtest/gtest.h>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class RunSceneFolder : public testing::Test
{
protected:
  RunSceneFolder () { writeRun (movingScene (), run_); }

  RunScene load () { return loadRunScene (run_, notes_); }

  std::string failure ()
  {
    return messageOf<IoError> ([this] { load (); });
  }

  TemporaryFolder folder_;
  const std::string run_ = folder_.file ("run");
  ReadingNotes notes_;
};

} // namespace

TEST_F (RunSceneFolder, EverythingIsRead)
{
  const RunScene scene = load ();
  EXPECT_TRUE (notes_.warnings.empty ()) << notes_.warnings.front ();
  EXPECT_EQ (scene.stamps ().size (), 24u);
  ASSERT_EQ (scene.run.objects.size (), 2u);
  EXPECT_EQ (scene.camera ().width, 320);
  EXPECT_EQ (scene.camera ().fx, 260.0);
  EXPECT_EQ (scene.dataset, "images");
  EXPECT_EQ (scene.source.format, SequenceFormat::Tum);
  EXPECT_EQ (scene.source.depth_scale, 5000.0);
  EXPECT_EQ (scene.surface (1, SurfaceMode::Completed).triangles.size (),
             movingScene ().objects[0].mesh.triangles.size ());
  EXPECT_LT (scene.surface (1, SurfaceMode::Tsdf).triangles.size (),
             scene.surface (1, SurfaceMode::Completed).triangles.size ());
  EXPECT_FALSE (scene.surface (1, SurfaceMode::Tsdf).empty ());
  EXPECT_FALSE (scene.surface (RunScene::background, SurfaceMode::Tsdf).empty ());
  EXPECT_TRUE (scene.surface (1, SurfaceMode::Points).empty ());
  EXPECT_TRUE (scene.surface (9, SurfaceMode::Completed).empty ());
}

TEST_F (RunSceneFolder, PosesAreThoseOfTheNearestFrame)
{
  const SceneRecord truth = movingScene ();
  const RunScene scene = movingRun ();
  for (const double stamp : {3.0, 3.4, 2.6})
  {
    EXPECT_TRUE (scene.cameraAt (stamp)->isApprox (truth.camera[3].pose, 1e-9)) << stamp;
    EXPECT_TRUE (scene.poseAt (scene.run.objects[1], stamp)->isApprox (truth.objects[1].poses[3].pose, 1e-9)) << stamp;
  }
  EXPECT_FALSE (scene.poseAt (scene.run.objects[1], 12.0)); // not known there
  EXPECT_TRUE (scene.poseAt (scene.run.objects[0], 12.0));
  EXPECT_FALSE (scene.cameraAt (24.0));
  EXPECT_FALSE (scene.cameraAt (-0.6));
}

TEST_F (RunSceneFolder, NothingIsWritten)
{
  std::map<std::string, std::pair<std::string, fs::file_time_type>> before, after;
  const auto look = [this] (auto& files) {
    for (const auto& entry : fs::recursive_directory_iterator (run_))
      files[entry.path ().string ()] = {entry.is_regular_file () ? readFile (entry.path ().string ()) : "",
                                        entry.last_write_time ()};
  };
  look (before);
  load ();
  look (after);
  EXPECT_EQ (before.size (), 11u);
  EXPECT_EQ (before, after);
}

TEST_F (RunSceneFolder, SurfacesAreDecimatedForDisplay)
{
  RunSceneOptions options;
  options.triangles = 1000;
  const RunScene scene = loadRunScene (run_, notes_, options);
  EXPECT_EQ (scene.run.background.triangles.size (), 128u); // had fewer
  EXPECT_LE (scene.run.objects[0].mesh.triangles.size (), 500u);
  EXPECT_GT (scene.run.objects[0].mesh.triangles.size (), 400u);
  EXPECT_TRUE (computeTopology (scene.run.objects[0].mesh).closed_manifold);
}

TEST_F (RunSceneFolder, OtherFoldersAreReported)
{
  fs::remove (run_ + "/trajectory/camera.txt");
  EXPECT_NE (failure ().find ("no trajectory/camera.txt"), std::string::npos);
  writeFile (run_ + "/summary.json", R"({"error": "no frame can be read"})");
  EXPECT_NE (failure ().find ("that run failed: no frame can be read"), std::string::npos);
  writeFile (run_ + "/gt-cam-0.txt", "");
  fs::remove_all (run_ + "/trajectory");
  fs::remove (run_ + "/summary.json");
  EXPECT_NE (failure ().find ("is a dataset"), std::string::npos);
  fs::remove_all (run_);
  EXPECT_NE (failure ().find ("is no folder"), std::string::npos);
}

TEST_F (RunSceneFolder, WhatIsMissingIsReported)
{
  fs::remove (run_ + "/summary.json");
  writeFile (run_ + "/mesh/object_1_tsdf.ply", "ply\nformat");
  fs::remove (run_ + "/mesh/object_2.ply");
  const RunScene scene = load ();
  ASSERT_EQ (notes_.warnings.size (), 2u);
  EXPECT_NE (notes_.warnings[0].find ("object_1_tsdf.ply"), std::string::npos);
  EXPECT_NE (notes_.warnings[1].find ("summary.json"), std::string::npos);
  EXPECT_FALSE (notes_.whole);
  EXPECT_FALSE (scene.run.intrinsics);
  EXPECT_EQ (scene.camera ().width, 640);
  EXPECT_TRUE (scene.surface (2, SurfaceMode::Completed).empty ());
  EXPECT_FALSE (scene.surface (2, SurfaceMode::Tsdf).empty ());
}

TEST_F (RunSceneFolder, ClassesAreThoseOfTheSummary)
{
  EXPECT_TRUE (load ().classes.empty ());
  writeFile (run_ + "/summary.json",
             R"({"objects": [{"id": 1, "class": "cup", "class_id": 41, "score": 0.9}, {"id": 2, "class": "45",
        "class_id": 45}]})");
  EXPECT_EQ (load ().classes, (std::map<int, std::string>{{1, "cup"}}));
}

TEST_F (RunSceneFolder, AnySummaryIsBorne)
{
  for (const char* const text :
       {"", "[1, 2]", "{", R"({"camera": 3, "parameters": [], "error": {}, "objects": {"id": 1}})",
        R"({"objects": [5, null, {"id": "1", "class": "cup"}, {"id": 1, "class": 7}, {"id": 1e300,
          "class": "cup"}]})",
        R"({"camera": {"width": -3, "height": 1e300, "fx": "a"}, "parameters": {"dataset": 7, "images": "x"}})"})
  {
    writeFile (run_ + "/summary.json", text);
    const RunScene scene = load ();
    EXPECT_FALSE (scene.run.intrinsics) << text;
    EXPECT_EQ (scene.run.objects.size (), 2u) << text;
    EXPECT_TRUE (scene.classes.empty ()) << text;
  }
}

/** \brief What pcl_cosection made of two of three inputs, 60 km from the origin of the world; the first of them has two
 * views, and the second object moves. */
class CompletionFolder : public testing::Test
{
protected:
  CompletionFolder ()
  {
    fs::create_directories (result_);
    write ("ply");
  }

  /** \brief The files, and the poses "[1, 0, 0, x], ..." of rotations by pi about x. */
  void write (const std::string& format)
  {
    saveMesh (boxMesh ({-0.1f, -0.2f, -0.3f}, {0.1f, 0.2f, 0.3f}), result_ + "/object_2." + format, origin_);
    saveMesh (boxMesh ({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f}), result_ + "/object_10." + format);
    saveMesh (planeMesh (1.0, 4), result_ + "/background." + format, origin_);
    const auto view = [] (int input, const std::string& x, const std::string& y) {
      return R"({"camera": {"width": 320, "height": 240, "fx": 260, "fy": 260, "cx": 159.5, "cy": 119.5}, )"
             R"("input": )" +
             std::to_string (input) + R"(, "T_world_sensor": [[1, 0, 0, 6000)" + x +
             R"(], [0, -1, 0, 0], [0, 0, -1, 2], [0, 0, 0, 1]], "T_world_object": {"10": )" +
             R"([[1, 0, 0, 60000], [0, 1, 0, )" + y + R"(], [0, 0, 1, 0], [0, 0, 0, 1]]}})";
    };
    writeFile (result_ + "/summary.json",
               R"({"objects": [{"id": 2}, {"id": 10}], "parameters": {"format": ")" + format +
                   R"("}, "origin_m": [60000, 0, 0], "support_planes": [[0, 0, 2, 1]], "views": [)" +
                   view (1, "0", "0.5") + "," + view (1, "7", "7.5") + "," + view (2, "1", "1.5") + "]}");
  }

  RunScene load ()
  {
    notes_ = {};
    return loadRunScene (result_, notes_);
  }

  TemporaryFolder folder_;
  const std::string result_ = folder_.file ("result");
  const Eigen::Vector3d origin_{60000.0, 0.0, 0.0};
  ReadingNotes notes_;
};

TEST_F (CompletionFolder, InputsAreFrames)
{
  for (const char* const format : {"ply", "stl", "obj"})
  {
    SCOPED_TRACE (format);
    write (format); // beside those of the other formats
    const RunScene scene = load ();
    EXPECT_TRUE (notes_.warnings.empty ()) << notes_.warnings.front ();
    EXPECT_TRUE (scene.of_views);
    EXPECT_EQ (scene.stamps (), (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ (scene.camera ().fx, 260.0);
    EXPECT_TRUE (scene.cameraAt (1.0)->translation ().isApprox (Eigen::Vector3d (0.0, 0.0, 2.0)));
    EXPECT_TRUE (scene.cameraAt (2.0)->translation ().isApprox (Eigen::Vector3d (1.0, 0.0, 2.0)));
    ASSERT_EQ (scene.run.objects.size (), 2u);
    EXPECT_EQ (scene.run.objects[0].id, 2);
    EXPECT_TRUE (scene.poseAt (scene.run.objects[0], 2.0)->isApprox (Eigen::Isometry3d::Identity ()));
    for (const double stamp : {1.0, 2.0})
      EXPECT_NEAR (scene.poseAt (scene.run.objects[1], stamp)->translation ().y (), stamp - 0.5, 1e-9);
    for (const int id : {2, 10, RunScene::background})
    {
      EXPECT_FALSE (scene.surface (id, SurfaceMode::Completed).empty ()) << id;
      for (const Eigen::Vector3f& vertex : scene.surface (id, SurfaceMode::Completed).vertices)
        EXPECT_LT (vertex.norm (), 2.0f) << id; // relative to origin_m
    }
    EXPECT_TRUE (upDirection (scene).isApprox (Eigen::Vector3d::UnitZ ()));
    EXPECT_NO_THROW (overview (scene).validate ());
  }
}

TEST_F (CompletionFolder, OtherFilesAreTold)
{
  fs::copy (result_ + "/object_2.ply", result_ + "/object_3.ply");
  fs::remove (result_ + "/object_10.ply");
  fs::remove (result_ + "/background.ply");
  fs::create_symlink ("background.ply", result_ + "/background.ply"); // to itself
  const RunScene scene = load ();
  EXPECT_EQ (scene.run.objects.size (), 2u);
  ASSERT_EQ (notes_.warnings.size (), 3u);
  EXPECT_NE (notes_.warnings[0].find ("object 3"), std::string::npos);
  EXPECT_NE (notes_.warnings[1].find ("object 10 is missing"), std::string::npos);
  EXPECT_NE (notes_.warnings[2].find ("background.ply"), std::string::npos);
}

TEST_F (CompletionFolder, OverviewComesNearWithoutCameras)
{
  const RunScene scene = load ();
  const Viewpoint with = overview (scene, M_PI), without = overview (scene, M_PI, false);
  EXPECT_LT ((without.eye - without.target).norm (), 0.8 * (with.eye - with.target).norm ());
}

TEST_F (CompletionFolder, WithoutViewsItIsSeenFromTheObservedSide)
{
  TriangleMesh box = boxMesh ({-0.1f, -0.2f, -0.3f}, {0.1f, 0.2f, 0.3f});
  box.normals.clear ();
  box.provenance.clear ();
  for (const Eigen::Vector3f& vertex : box.vertices)
  {
    box.normals.push_back (vertex.normalized ());
    box.provenance.push_back (
        static_cast<std::uint8_t> (vertex.x () > 0 ? Provenance::Observed : Provenance::Inferred));
  }
  saveMesh (box, result_ + "/object_2.ply");
  for (const char* const name : {"/object_10.ply", "/background.ply"})
    fs::remove (result_ + name);
  for (const char* const text :
       {"{}", R"({"views": []})", R"({"views": [3, {}, {"T_world_sensor": 5}, {"T_world_sensor": [[1]]}]})",
        R"({"views": [{"T_world_sensor": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})",
        R"({"views": [{"T_world_sensor": [[1, 0, 0, "a"], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}],
            "support_planes": [[0, 0, 0, 1]]})",
        R"({"views": [{"T_world_sensor": [[1, 0, 0, 1e300], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}],
            "support_planes": [[1e200, 0, 0, 1]]})"})
  {
    writeFile (result_ + "/summary.json", text);
    notes_ = {};
    const RunScene scene = load ();
    ASSERT_EQ (notes_.warnings.size (), 1u) << text;
    EXPECT_NE (notes_.warnings[0].find ("does not say from where it was seen"), std::string::npos);
    EXPECT_GT (scene.cameraAt (0.0)->translation ().x (), 0.3) << text;
    EXPECT_TRUE (scene.poseAt (scene.run.objects[0], 0.0));
    EXPECT_FALSE (scene.up) << text;
  }
}

TEST (SceneErrors, AreTheDistanceToTheTruth)
{
  const SceneRecord truth = movingScene ();
  RunScene scene;
  scene.run = inOtherFrames (truth);
  constexpr float error_m = 0.004f;
  for (SceneRecord::Object& object : scene.run.objects)
    if (object.id == 8) // the torus
    {
      const TriangleMesh thicker = torusMesh (0.12, 0.05 + error_m, 48, 24);
      const Eigen::Isometry3d T_frame_object = object.poses[0].pose.inverse () * truth.camera[0].pose.inverse () *
                                               truth.objects[0].poses[0].pose;
      object.mesh = transformMesh (thicker, T_frame_object);
    }
  measureErrors (scene, truth);
  const std::vector<double>& torus = scene.surfaceErrors (8, SurfaceMode::Completed);
  ASSERT_EQ (torus.size (), scene.surface (8, SurfaceMode::Completed).vertices.size ());
  for (const double e : torus)
    EXPECT_NEAR (e, error_m, 0.0012);
  for (const double e : scene.surfaceErrors (7, SurfaceMode::Completed))
    EXPECT_LT (e, 1e-4);
  for (const double e : scene.surfaceErrors (RunScene::background, SurfaceMode::Tsdf))
    EXPECT_LT (e, 1e-4);
  EXPECT_TRUE (scene.surfaceErrors (8, SurfaceMode::Tsdf).empty ()); // there is none
  EXPECT_GE (scene.error_max_m, 0.004);
  EXPECT_LE (scene.error_max_m, 0.006);
}
