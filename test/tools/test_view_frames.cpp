// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with views in another frame than their sensor's.

#include "any_cloud_fixture.h"

#include "completion_frame.h"

#include <pcl/common/transforms.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <utility>

using ViewFrames = AnyCloud;

/** \brief In the frame of a robot's base, whatever of the sensor's place is known. */
TEST_F (ViewFrames, ViewsInTheWorldFrameAreAsGood)
{
  writeTableScene (path ("view.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> cloud, unordered;
  pcl::io::loadPCDFile (path ("view.pcd"), cloud);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity (); // the world's origin: on the floor below the table
  T.translate (Eigen::Vector3f (0.2f, 0.1f, 0.7f));
  T.translate (cloud.sensor_origin_.head<3> ());
  T.rotate (cloud.sensor_orientation_);
  const Eigen::Vector3f sensor = T.translation ();
  for (auto& p : cloud)
    p.getVector3fMap () = T * Eigen::Vector3f (p.getVector3fMap ());
  cloud.sensor_origin_.setZero ();
  cloud.sensor_orientation_.setIdentity ();
  pcl::io::savePCDFileBinary (path ("organized.pcd"), cloud);
  cloud.sensor_origin_.head<3> () = sensor;
  pcl::io::savePCDFileBinary (path ("told.pcd"), cloud);
  for (const auto& p : cloud)
    if (std::isfinite (p.x))
      unordered.push_back (p);
  pcl::io::savePCDFileBinary (path ("unorganized.pcd"), unordered);
  std::shuffle (unordered.begin (), unordered.end (), std::mt19937 (1));
  pcl::io::savePCDFileBinary (path ("shuffled.pcd"), unordered);
  unordered.sensor_origin_.head<3> () = sensor;
  pcl::io::savePCDFileBinary (path ("shuffled_told.pcd"), unordered);
  const std::string place = std::to_string (sensor.x ()) + "," + std::to_string (sensor.y ()) + "," +
                            std::to_string (sensor.z ());

  ASSERT_EQ (run ({"view.pcd", "expected"}), 0) << errors_;
  const std::pair<std::vector<std::string>, std::string> views[] = {
      {{"organized.pcd"}, "their pixels tell that it stood at"},
      {{"told.pcd"}, "taken as with --world-points"},
      {{"unorganized.pcd"}, "the order of its points tells"},
      {{"--viewpoint", place, "organized.pcd"}, ""},
      {{"--viewpoint", place, "shuffled.pcd"}, ""},
      {{"shuffled_told.pcd"}, "taken as with --world-points"}};
  for (const auto& [arguments, said] : views)
  {
    SCOPED_TRACE (arguments.back ());
    std::vector<std::string> all = arguments;
    all.emplace_back ("out");
    ASSERT_EQ (run (all), 0) << errors_;
    EXPECT_NE (errors_.find (said), std::string::npos) << errors_;
    if (said.empty ())
    {
      EXPECT_EQ (errors_, "");
    }
    for (const char* object : {"object_1.ply", "object_2.ply"})
      EXPECT_NEAR (volume (std::string ("out/") + object), volume (std::string ("expected/") + object),
                   0.1 * volume (std::string ("expected/") + object));
  }
}

/** \brief One file of two views was not seen from one place, near as these may be. */
TEST_F (ViewFrames, MergedViewsWithoutTheirOrderHaveNoViewpoint)
{
  writeTableScene (path ("view.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> view, merged;
  pcl::io::loadPCDFile (path ("view.pcd"), view);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity ();
  T.translate (view.sensor_origin_.head<3> ());
  T.rotate (view.sensor_orientation_);
  for (const float turn : {0.0f, 1.2f}) // the same seen from elsewhere, about the vertical axis
    for (const auto& p : view)
      if (std::isfinite (p.x))
      {
        merged.push_back (p);
        merged.back ().getVector3fMap () = Eigen::AngleAxisf (turn, Eigen::Vector3f::UnitZ ()) *
                                           (T * Eigen::Vector3f (p.getVector3fMap ()));
      }
  std::shuffle (merged.begin (), merged.end (), std::mt19937 (1));
  pcl::io::savePCDFileBinary (path ("merged.pcd"), merged);
  EXPECT_EQ (run ({"merged.pcd", "out"}), 0);
  EXPECT_EQ (errors_.find ("the order of its points tells"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("where its points were seen from is not known"), std::string::npos) << errors_;
}

TEST_F (ViewFrames, ViewpointsThatAreNoneAreNamed)
{
  writeSphere (path ("ball.pcd"), 1000);
  const auto fails = [this] (std::vector<std::string> arguments, const std::string& part) {
    arguments.insert (arguments.end (), {"ball.pcd", "ball.pcd", "ball.pcd", "out.ply"});
    EXPECT_EQ (run (arguments), 2);
    EXPECT_NE (errors_.find (part), std::string::npos) << errors_;
  };
  fails ({"--viewpoint", "1,2"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,3,4"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,nan"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,3", "--viewpoint", "1,2,4"}, "--viewpoint is given 2 times for 3 views");
}

namespace {

const Eigen::Quaterniond some_turn = Eigen::Quaterniond (0.5, -0.3, 0.7, 0.4).normalized ();

} // namespace

TEST_F (ViewFrames, ResultsTurnWithTheViewpoint)
{
  writeTableScene (path ("view.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> cloud;
  pcl::io::loadPCDFile (path ("view.pcd"), cloud);
  const Eigen::Quaternionf turn = some_turn.cast<float> ();
  cloud.sensor_origin_.head<3> () = turn * cloud.sensor_origin_.head<3> ();
  cloud.sensor_orientation_ = turn * cloud.sensor_orientation_;
  pcl::io::savePCDFileBinary (path ("turned.pcd"), cloud);
  const auto complete = [&] (const std::string& name) {
    EXPECT_EQ (run ({"--save-hull", "--json", "s.json", name + ".pcd", name}), 0) << errors_;
    return summary ();
  };
  const nlohmann::json given = complete ("view"), moved = complete ("turned");

  for (const char* file : {"/object_1.ply", "/object_2.ply", "/object_1_hull.ply"})
  {
    SCOPED_TRACE (file);
    const pcl::cosection::TriangleMesh before = pcl::cosection::loadPlyMesh (path ("view") + file);
    const pcl::cosection::TriangleMesh after = pcl::cosection::loadPlyMesh (path ("turned") + file);
    ASSERT_EQ (before.normals.size (), before.vertices.size ());
    ASSERT_EQ (after.normals.size (), after.vertices.size ());
    std::size_t same = 0; // rounding moves a few vertices of hidden edges
    for (std::size_t v = 0; v < before.vertices.size (); ++v)
      for (std::size_t w = 0; w < after.vertices.size (); ++w)
        if ((turn * before.vertices[v] - after.vertices[w]).squaredNorm () < 1e-8f &&
            (turn * before.normals[v]).dot (after.normals[w]) > 0.999f)
        {
          ++same;
          break;
        }
    EXPECT_GT (static_cast<double> (same), 0.97 * static_cast<double> (before.vertices.size ()));
  }
  const auto vectorOf = [] (const nlohmann::json& numbers) {
    return Eigen::Vector3d (numbers.at (0), numbers.at (1), numbers.at (2));
  };
  const nlohmann::json plane = given.at ("support_planes").at (0), turned_plane = moved.at ("support_planes").at (0);
  EXPECT_LT ((some_turn * vectorOf (plane) - vectorOf (turned_plane)).norm (), 1e-4);
  EXPECT_NEAR (plane.at (3), turned_plane.at (3), 1e-4);
  for (const Eigen::Vector3f& v : pcl::cosection::loadMesh (path ("turned/background.ply")).vertices)
    ASSERT_NEAR (vectorOf (turned_plane).dot (v.cast<double> ()) + turned_plane.at (3).get<double> (), 0.0, 0.005);
  const nlohmann::json sensor = moved.at ("views").at (0).at ("T_world_sensor");
  for (int row = 0; row < 3; ++row)
    EXPECT_NEAR (sensor.at (row).at (3), cloud.sensor_origin_[row], 1e-5);
}

/** \brief Of a ball; the corners of the turned volume are outside of the one that was solved. */
TEST_F (ViewFrames, SignedDistancesAreSampledAlongTheWorldsAxes)
{
  constexpr double radius_m = 0.05;
  const Eigen::Vector3d middle (0.3, -0.2, 1.0);
  auto field = std::make_shared<pcl::cosection::SignedDistanceField> ();
  field->grid = {{40, 30, 30}, 0.005, middle - Eigen::Vector3d (0.1, 0.07, 0.08)};
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 40; ++i)
        field->values.push_back (static_cast<float> ((field->grid.center (i, j, k) - middle).norm () - radius_m));
  field->supported.assign (field->values.size (), 1);
  pcl::cosection::SceneResult result;
  result.objects.resize (1);
  result.objects[0].id = 1;
  result.objects[0].signed_distance = field;
  turnResult (some_turn, Settings (), result);

  const pcl::cosection::SignedDistanceField& turned = *result.objects[0].signed_distance;
  EXPECT_GT (turned.values.size (), field->values.size ());
  const double cells = 39 * 29 * 29;
  EXPECT_NEAR (std::count (turned.supported.begin (), turned.supported.end (), 1), cells, 0.01 * cells);
  for (int k = 0; k < turned.grid.dims.z (); ++k)
    for (int j = 0; j < turned.grid.dims.y (); ++j)
      for (int i = 0; i < turned.grid.dims.x (); ++i)
      {
        const double expected = (turned.grid.center (i, j, k) - some_turn * middle).norm () - radius_m;
        const std::size_t n = turned.grid.index (i, j, k);
        ASSERT_NEAR (turned.values[n], expected, turned.supported[n] != 0 ? 0.002 : 0.05);
        ASSERT_GE (turned.supported[n] + turned.values[n], 0.0f); // the ball is where it was solved
      }
}

/** \brief What is in the world turns; what is in the frame of an object that moves does not. */
TEST_F (ViewFrames, ObjectsThatMoveStayInTheirFrames)
{
  const Eigen::Vector3f corner (1.0f, 2.0f, 3.0f);
  pcl::cosection::SceneResult result;
  for (const int id : {1, 2})
  {
    pcl::cosection::ObjectResult& object = result.objects.emplace_back ();
    object.id = id;
    object.mesh.vertices = {corner};
    object.guessed_plane = Eigen::Vector4d (0.0, 0.0, 1.0, -0.3);
    object.proposal.emplace ();
    object.proposal->T_object_proposal.translation () = corner.cast<double> ();
  }
  Settings settings;
  settings.object_trajectories[2] = "trajectory.txt";
  turnResult (some_turn, settings, result);

  const Eigen::Vector3d turned = some_turn * corner.cast<double> ();
  EXPECT_LT ((result.objects[0].mesh.vertices[0].cast<double> () - turned).norm (), 1e-6);
  EXPECT_LT ((result.objects[0].proposal->T_object_proposal.translation () - turned).norm (), 1e-12);
  EXPECT_EQ (result.objects[1].mesh.vertices[0], corner);
  EXPECT_EQ (result.objects[1].proposal->T_object_proposal.translation (), corner.cast<double> ());
  for (const pcl::cosection::ObjectResult& object : result.objects)
  {
    EXPECT_LT ((object.guessed_plane->head<3> () - some_turn * Eigen::Vector3d::UnitZ ()).norm (), 1e-12);
    EXPECT_EQ ((*object.guessed_plane)[3], -0.3);
  }
}

namespace {

/** \brief The table scene with its points changed. */
class ChangedTable : public AnyCloud
{
protected:
  using Cloud = pcl::PointCloud<pcl::PointXYZRGBL>;

  Cloud table () const
  {
    writeTableScene (path ("table.pcd"));
    Cloud cloud;
    pcl::io::loadPCDFile (path ("table.pcd"), cloud);
    return cloud;
  }

  bool isSaid (const std::string& part) const { return errors_.find (part) != std::string::npos; }

  /** \brief Without the readings of some labels. */
  void saveWithout (const std::string& name, const std::set<std::uint32_t>& labels) const
  {
    Cloud cloud = table ();
    for (auto& p : cloud)
      if (labels.count (p.label) > 0)
        p.getVector3fMap ().setConstant (std::numeric_limits<float>::quiet_NaN ());
    pcl::io::savePCDFileBinary (path (name), cloud);
  }
};

} // namespace

TEST_F (ChangedTable, LabelsThatWereNumberedViewByViewAreSaid)
{
  const std::string warning = "what has label 1 has label 2 in a view before";
  Cloud swapped = table ();
  for (auto& p : swapped)
    p.label = p.label == 0 ? 0 : 3 - p.label;
  pcl::io::savePCDFileBinary (path ("swapped.pcd"), swapped);
  ASSERT_EQ (run ({"table.pcd", "swapped.pcd", "out"}), 0) << errors_;
  EXPECT_TRUE (isSaid (warning)) << errors_;
  ASSERT_EQ (run ({"table.pcd", "table.pcd", "out"}), 0) << errors_;
  EXPECT_FALSE (isSaid ("in a view before")) << errors_;
}

TEST_F (ChangedTable, NothingIsSaidOfWhatWasCutOut)
{
  saveWithout ("both.pcd", {0});
  ASSERT_EQ (run ({"both.pcd", "out"}), 0) << errors_;
  EXPECT_FALSE (isSaid ("extends farther") || isSaid ("of its outline")) << errors_;
  saveWithout ("box.pcd", {0, 1});
  pcl::PointCloud<pcl::PointXYZ> box;
  pcl::io::loadPCDFile (path ("box.pcd"), box);
  pcl::Indices kept;
  pcl::removeNaNFromPointCloud (box, box, kept);
  pcl::io::savePCDFileBinary (path ("points.pcd"), box);
  ASSERT_EQ (run ({"points.pcd", "out"}), 0) << errors_;
  EXPECT_FALSE (isSaid ("give --segment")) << errors_;
}

TEST_F (ChangedTable, PointsOfTheWorldInLargeCellsAreFound)
{
  Cloud world = table (), cells;
  ASSERT_EQ (run ({"table.pcd", "out"}), 0) << errors_;
  const Eigen::Affine3f T (Eigen::Translation3f (world.sensor_origin_.head<3> ()) * world.sensor_orientation_);
  pcl::transformPointCloud (world, world, T);
  for (std::uint32_t label = 0; label < 3; ++label)
  {
    Cloud one, thinned;
    std::copy_if (world.begin (), world.end (), std::back_inserter (one),
                  [&] (const auto& p) { return p.label == label && std::isfinite (p.z); });
    pcl::VoxelGrid<pcl::PointXYZRGBL> filter;
    filter.setInputCloud (one.makeShared ());
    filter.setLeafSize (0.01f, 0.01f, 0.01f);
    filter.filter (thinned);
    cells += thinned;
  }
  cells.sensor_origin_ = world.sensor_origin_;
  cells.sensor_orientation_ = world.sensor_orientation_;
  pcl::io::savePCDFileBinary (path ("cells.pcd"), cells);
  ASSERT_EQ (run ({"cells.pcd", "thin"}), 0) << errors_;
  EXPECT_TRUE (isSaid ("taken as with --world-points")) << errors_;
  for (const std::string mesh : {"/object_1.ply", "/object_2.ply"})
    EXPECT_LT ((centroid ("thin" + mesh) - centroid ("out" + mesh)).norm (), 0.01) << mesh;
}
