// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Clouds as surveys, other programs and sensors have them: coordinates, grounds, labels, and none.

#include "any_cloud_fixture.h"

#include <pcl/common/transforms.h>

#include <filesystem>
#include <random>
#include <set>
#include <sstream>

namespace fs = std::filesystem;
using namespace pcl::cosection;

TEST_F (AnyCloud, SurveyCoordinatesGiveTheSameMesh)
{
  writeSphere (path ("near.pcd"), 8000);
  pcl::PointCloud<pcl::PointNormal> near;
  pcl::io::loadPCDFile (path ("near.pcd"), near);
  std::ostringstream rows;
  rows.precision (12);
  const Eigen::Vector3d utm (512434.25, 5405590.5, 348.75);
  for (const pcl::PointNormal& p : near)
    rows << p.x + utm.x () << ' ' << p.y + utm.y () << ' ' << p.z + utm.z () << ' ' << p.normal_x << ' ' << p.normal_y
         << ' ' << p.normal_z << '\n';
  write ("far.pcd", "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 8 8 8 4 4 4\nTYPE F F F F F F\n"
                    "COUNT 1 1 1 1 1 1\nWIDTH 8000\nHEIGHT 1\nPOINTS 8000\nDATA ascii\n" +
                        rows.str ());
  ASSERT_EQ (run ({"--plane", "0,0,1,-349.15", "--save-sdf", "--json", "s.json", "far.pcd", "far.ply"}), 0) << errors_;
  EXPECT_NE (errors_.find ("far from their origin"), std::string::npos) << errors_;
  const TriangleMesh mesh = loadMesh (path ("far.ply"), utm);
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  EXPECT_NEAR (computeMassProperties (mesh).volume_m3, ball_m3, 0.02 * ball_m3);
  const nlohmann::json centroid = summary ()["objects"][0]["centroid_m"];
  EXPECT_NEAR (centroid[0].get<double> (), utm.x (), 1e-3);
  EXPECT_NEAR (centroid[1].get<double> (), utm.y (), 1e-3);
  EXPECT_NEAR (centroid[2].get<double> (), utm.z () + 0.5, 1e-3);
  EXPECT_EQ (summary ()["origin_m"].size (), 3u);

  ASSERT_EQ (run ({"far.pcd", "far.stl"}), 0) << errors_;
  EXPECT_NE (errors_.find ("STL files have single precision"), std::string::npos) << errors_;
  EXPECT_NEAR (volume ("far.stl"), ball_m3, 0.02 * ball_m3);
}

TEST_F (AnyCloud, DepositOnGroundHasTheVolumeAboveIt)
{
  std::mt19937 random (9);
  std::uniform_real_distribution<double> along (-4.0, 4.0);
  std::normal_distribution<double> noise (0.0, 0.005);
  std::ostringstream rows;
  constexpr int count = 20000;
  for (int n = 0; n < count; ++n)
  {
    const Eigen::Vector2d at (along (random), along (random));
    rows << at.x () << ' ' << at.y () << ' ' << std::max (0.0, 1.2 - 0.5 * at.norm ()) + noise (random) << '\n';
  }
  write ("heap.pcd", "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + std::to_string (count) +
                         "\nHEIGHT 1\nPOINTS " + std::to_string (count) + "\nDATA ascii\n" + rows.str ());
  ASSERT_EQ (run ({"--plane", "0,0,1,0", "heap.pcd", "heap.ply"}), 0) << errors_;
  const double true_m3 = M_PI * 2.4 * 2.4 * 1.2 / 3.0;
  EXPECT_NEAR (volume ("heap.ply"), true_m3, 0.03 * true_m3);
}

TEST_F (AnyCloud, BackgroundOfAnotherLabel)
{
  writeTableScene (path ("table.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> table;
  pcl::io::loadPCDFile (path ("table.pcd"), table);
  for (pcl::PointXYZRGBL& p : table)
    p.label = p.label == 0 ? 255 : p.label - 1; // objects from 0
  pcl::io::savePCDFileBinary (path ("other.pcd"), table);
  ASSERT_EQ (run ({"table.pcd", "first"}), 0) << errors_;
  ASSERT_EQ (run ({"--background", "255", "other.pcd", "second"}), 0) << errors_;
  EXPECT_NE (errors_.find ("label 0 is no background; it is object 255"), std::string::npos) << errors_;
  EXPECT_NEAR (volume ("second/object_255.ply"), volume ("first/object_1.ply"), 1e-6);
  EXPECT_NEAR (volume ("second/object_1.ply"), volume ("first/object_2.ply"), 1e-6);
  EXPECT_TRUE (fs::exists (path ("second/background.ply")));

  for (pcl::PointXYZRGBL& p : table)
    p.label += p.label == 255 ? -252 : 1; // the table is 3
  pcl::io::savePCDFileBinary (path ("third.pcd"), table);
  ASSERT_EQ (run ({"third.pcd", "third"}), 0) << errors_;
  EXPECT_NE (errors_.find ("give --background 3"), std::string::npos) << errors_;
  ASSERT_EQ (run ({"--background", "7", "table.pcd", "fourth"}), 0) << errors_;
  EXPECT_NE (errors_.find ("object 7, which has label 0, extends farther than all others together; if it is the "
                           "background, leave out --background 7"),
             std::string::npos)
      << errors_;
  EXPECT_EQ (errors_.find ("give --background"), std::string::npos) << errors_;
}

TEST_F (AnyCloud, TheInsideOfABinIsClosedAtItsMouth)
{
  std::mt19937 random (4);
  std::uniform_real_distribution<float> share (0.0f, 1.0f);
  std::normal_distribution<float> noise (0.0f, 0.001f);
  for (const Eigen::Vector3f& size : {Eigen::Vector3f (0.6f, 0.4f, 0.45f), Eigen::Vector3f (0.3f, 0.3f, 0.5f)})
  {
    pcl::PointCloud<pcl::PointNormal> inside;
    for (const int axis : {0, 1, 2})
      for (const float side : {0.0f, 1.0f})
      {
        if (axis == 2 && side > 0.0f)
          continue; // the mouth
        const float area = size.prod () / size[axis];
        for (int n = 0; n < static_cast<int> (20000.0f * area); ++n)
        {
          pcl::PointNormal point;
          for (int k = 0; k < 3; ++k)
            point.data[k] = size[k] * (k == axis ? side : share (random)) + noise (random);
          point.getNormalVector3fMap () = (side > 0.0f ? -1.0f : 1.0f) * Eigen::Vector3f::Unit (axis);
          inside.push_back (point);
        }
      }
    const Eigen::Affine3f turned (Eigen::AngleAxisf (0.7f, Eigen::Vector3f (1.0f, 2.0f, 3.0f).normalized ()));
    pcl::transformPointCloudWithNormals (inside, inside, turned);
    pcl::io::savePCDFileBinary (path ("bin.pcd"), inside);
    ASSERT_EQ (run ({"bin.pcd", "bin.ply"}), 0) << errors_;
    EXPECT_NEAR (volume ("bin.ply"), size.prod (), 0.03 * size.prod ());
  }
}

TEST_F (AnyCloud, AViewThatIsGivenTwiceCountsOnce)
{
  writeTableScene (path ("table.pcd"));
  ASSERT_EQ (run ({"table.pcd", "once"}), 0) << errors_;
  ASSERT_EQ (run ({"table.pcd", "table.pcd", "twice"}), 0) << errors_;
  EXPECT_NE (errors_.find ("object 1: 50 % of its points repeat others, and are left out"), std::string::npos)
      << errors_;
  for (const std::string body : {"/object_1.ply", "/object_2.ply", "/background.ply"})
    EXPECT_EQ (test::readFile (path ("once" + body)), test::readFile (path ("twice" + body))) << body;
}

/** \brief Normals in another unit differ by rounding alone, and so do the meshes, though two orders of the same mirror
 * planes of a box are equally good. */
TEST_F (AnyCloud, NormalsOfAnyLengthGiveTheSameMesh)
{
  std::mt19937 random (7);
  std::uniform_real_distribution<float> place (-0.5f, 0.5f);
  std::normal_distribution<float> noise (0.0f, 1.0f);
  for (int box = 0; box < 3; ++box)
  {
    const Eigen::Array3f size_m (0.1f + 0.02f * box, 0.14f, 0.08f);
    const Eigen::Matrix3f
        R = Eigen::Quaternionf (1.0f, noise (random), noise (random), noise (random)).normalized ().matrix ();
    pcl::PointCloud<pcl::PointNormal> points;
    for (int side = 0; side < 3; ++side)
      for (int i = 0; i < 900; ++i)
      {
        Eigen::Array3f p = size_m * Eigen::Array3f::NullaryExpr ([&] { return place (random); });
        p[side] = 0.5f * size_m[side];
        const auto jitter = [&] { return Eigen::Vector3f::NullaryExpr ([&] { return noise (random); }); };
        points.emplace_back ();
        points.back ().getVector3fMap () = R * (p.matrix () + 0.001f * jitter ()) + Eigen::Vector3f::UnitZ ();
        points.back ().getNormalVector3fMap () = R * (Eigen::Vector3f::Unit (side) + 0.05f * jitter ()).normalized ();
      }
    std::vector<double> volumes;
    for (const float length : {1.0f, 1e-3f, 1e-6f})
    {
      pcl::PointCloud<pcl::PointNormal> scaled = points;
      for (pcl::PointNormal& point : scaled)
        point.getNormalVector3fMap () *= length;
      pcl::io::savePCDFileBinary (path ("box.pcd"), scaled);
      ASSERT_EQ (run ({"box.pcd", "box.ply"}), 0) << errors_;
      volumes.push_back (volume ("box.ply"));
    }
    for (const double other : volumes)
      EXPECT_NEAR (other, volumes[0], 1e-5 * volumes[0]) << box;
  }
}

namespace {

/** \brief What a spinning lidar 1.7 m over the ground sees of boxes that stand around it, each turned by another angle;
 * label k + 1 for box k. */
pcl::PointCloud<pcl::PointXYZL>
turnAmongBoxes (const Eigen::Array3f& size_m, const std::vector<float>& angles)
{
  constexpr int columns = 1024, rows = 64;
  constexpr float height_m = 1.7f, distance_m = 5.0f, wall_m = 60.0f;
  std::mt19937 random (3);
  std::normal_distribution<float> noise_m (0.0f, 0.01f);
  pcl::PointCloud<pcl::PointXYZL> cloud (columns, rows);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
    {
      const float azimuth = 2.0f * static_cast<float> (M_PI) * u / columns, elevation = 0.25f - 0.011f * v;
      const Eigen::Vector3f ray (std::cos (azimuth) * std::cos (elevation), std::sin (azimuth) * std::cos (elevation),
                                 std::sin (elevation));
      float range = std::min (wall_m, ray.z () < 0.0f ? -height_m / ray.z () : wall_m);
      std::uint32_t label = 0;
      for (std::size_t b = 0; b < angles.size (); ++b)
      {
        const float at = 2.0f * static_cast<float> (M_PI) * static_cast<float> (b) / angles.size ();
        const Eigen::Vector3f middle (distance_m * std::cos (at), distance_m * std::sin (at),
                                      0.5f * size_m.z () - height_m);
        const Eigen::Matrix3f to_box (Eigen::AngleAxisf (-at - angles[b], Eigen::Vector3f::UnitZ ()));
        const Eigen::Array3f from = to_box * -middle, along = to_box * ray;
        const Eigen::Array3f one = (-0.5f * size_m - from) / along, other = (0.5f * size_m - from) / along;
        const float enter = one.min (other).maxCoeff (), leave = one.max (other).minCoeff ();
        if (enter < leave && enter > 0.0f && enter < range)
        {
          range = enter;
          label = static_cast<std::uint32_t> (b) + 1;
        }
      }
      cloud (u, v).getVector3fMap () = (range + noise_m (random)) * ray;
      cloud (u, v).label = label;
    }
  return cloud;
}

} // namespace

/** \brief Readings on the sides of a thing that are seen aslant are far apart. */
TEST_F (AnyCloud, ATurnOfALidarGivesBoxesTheirVolumes)
{
  const Eigen::Array3f size_m (1.0f, 0.8f, 1.2f);
  pcl::io::savePCDFileBinary (path ("turn.pcd"), turnAmongBoxes (size_m, {0.2f, 0.4f, 0.8f, 1.2f}));
  ASSERT_EQ (run ({"turn.pcd", "out"}), 0) << errors_;
  EXPECT_EQ (errors_, "");
  for (const std::string id : {"1", "2", "3", "4"})
    EXPECT_NEAR (volume ("out/object_" + id + ".ply"), size_m.prod (), 0.2 * size_m.prod ()) << id;
}

/** \brief The front of these is seen, and hardly any of the top. */
TEST_F (AnyCloud, ATurnOfALidarGivesBoxesSeenHeadOnTheirVolumes)
{
  const Eigen::Array3f size_m (0.8f, 1.2f, 1.2f);
  pcl::io::savePCDFileBinary (path ("turn.pcd"), turnAmongBoxes (size_m, {0.0f, 0.02f, -0.03f}));
  ASSERT_EQ (run ({"turn.pcd", "out"}), 0) << errors_;
  for (const std::string id : {"1", "2", "3"})
  {
    EXPECT_NE (errors_.find ("object " + id + ": only one side of it was seen"), std::string::npos) << errors_;
    EXPECT_NEAR (volume ("out/object_" + id + ".ply"), size_m.prod (), 0.2 * size_m.prod ()) << id;
  }
}

/** \brief Views that were put one after the other into one cloud: their order tells where each was seen from. */
TEST_F (AnyCloud, MergedViewsAreFoundByTheirOrder)
{
  ToolRun simulate ({"--preset", "table", "sim"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (simulate.wait (), 0) << simulate.errors ();
  std::vector<std::string> views;
  pcl::PointCloud<pcl::PointXYZL> merged, view, in_world;
  for (int v = 0; v < 4; ++v)
  {
    views.push_back ("sim/views/View000" + std::to_string (v) + ".pcd");
    pcl::io::loadPCDFile (path (views.back ()), view);
    const Eigen::Affine3f T (Eigen::Translation3f (view.sensor_origin_.head<3> ()) * view.sensor_orientation_);
    pcl::transformPointCloud (view, in_world, T);
    for (const pcl::PointXYZL& point : in_world)
      if (std::isfinite (point.z))
        merged.push_back (point);
  }
  std::vector<std::string> one_by_one = views;
  one_by_one.insert (one_by_one.end (), {"--quiet", "separate"});
  ASSERT_EQ (run (one_by_one), 0) << errors_;
  merged.sensor_origin_ = view.sensor_origin_; // as of one of them, though the points are in the world
  merged.sensor_orientation_ = view.sensor_orientation_;
  pcl::io::savePCDFileBinary (path ("merged.pcd"), merged);
  ASSERT_EQ (run ({"merged.pcd", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("it holds 4 views, which were seen from "), std::string::npos) << errors_;
  for (const std::string id : {"1", "2", "3", "4", "5"})
  {
    const std::string mesh = "/object_" + id + ".ply";
    EXPECT_NEAR (volume ("out" + mesh), volume ("separate" + mesh), 0.1 * volume ("separate" + mesh)) << id;
    EXPECT_LT ((centroid ("out" + mesh) - centroid ("separate" + mesh)).norm (), 0.002) << id;
  }
}

TEST_F (AnyCloud, ObjectsAreFoundFirst)
{
  writeTableScene (path ("table.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> table;
  pcl::io::loadPCDFile (path ("table.pcd"), table);
  pcl::PointCloud<pcl::PointXYZRGB> image (table.width, table.height), points;
  image.sensor_origin_ = points.sensor_origin_ = table.sensor_origin_;
  image.sensor_orientation_ = points.sensor_orientation_ = table.sensor_orientation_;
  for (std::size_t i = 0; i < table.size (); ++i)
  {
    image[i].getVector3fMap () = table[i].getVector3fMap ();
    if (table[i].getVector3fMap ().allFinite ())
      points.push_back (image[i]);
  }
  pcl::io::savePCDFileBinary (path ("image.pcd"), image);
  pcl::io::savePCDFileBinary (path ("points.pcd"), points);
  ASSERT_EQ (run ({"table.pcd", "labelled"}), 0) << errors_;
  for (const std::string name : {"image", "points"})
  {
    ASSERT_EQ (run ({"--segment", "--save-labels", "found.pcd", name + ".pcd", name}), 0) << errors_;
    double sum = 0.0, expected = 0.0;
    for (const char* object : {"/object_1.ply", "/object_2.ply"})
    {
      sum += volume (name + object);
      expected += volume (std::string ("labelled") + object);
    }
    EXPECT_NEAR (sum, expected, 0.1 * expected) << name;
    EXPECT_FALSE (fs::exists (path (name + "/object_3.ply")));
    ASSERT_EQ (run ({"found.pcd", "again"}), 0) << errors_;
    EXPECT_NEAR (volume ("again/object_1.ply"), volume (name + "/object_1.ply"), 1e-9);
  }
  pcl::PointCloud<pcl::PointXYZ> one;
  for (const pcl::PointXYZRGBL& point : table)
    if (point.label == 1 && point.getVector3fMap ().allFinite ())
      one.emplace_back (point.x, point.y, point.z);
  pcl::io::savePCDFileBinary (path ("one.pcd"), one);
  ASSERT_EQ (run ({"points.pcd", "all"}), 0) << errors_;
  EXPECT_NE (errors_.find ("2 things in it stand on a plane: give --segment"), std::string::npos) << errors_;
  ASSERT_EQ (run ({"one.pcd", "one"}), 0) << errors_;
  EXPECT_EQ (errors_.find ("--segment"), std::string::npos) << errors_;
  for (pcl::PointXYZRGB& point : image)
    point.getVector3fMap () *= 1000.0f;
  pcl::io::savePCDFileBinary (path ("millimetres.pcd"), image);
  EXPECT_EQ (run ({"--segment", "millimetres.pcd", "out"}), 1);
  EXPECT_NE (errors_.find ("give --scale 0.001"), std::string::npos) << errors_;
  EXPECT_EQ (run ({"--segment", "image.pcd", "points.pcd", "out"}), 2);
  EXPECT_EQ (run ({"--segment", "--max-object-size", "0.04", "image.pcd", "out"}), 1); // both are longer
  EXPECT_NE (errors_.find ("no object was found on its planes"), std::string::npos) << errors_;
  EXPECT_EQ (run ({"--segment", "--max-object-size", "0.02", "image.pcd", "out"}), 2);
  EXPECT_EQ (run ({"--max-object-size", "1", "image.pcd", "out"}), 2);
  EXPECT_EQ (run ({"--save-labels", "l.pcd", "image.pcd", "out"}), 2);
  EXPECT_EQ (run ({"--segment", "--save-labels", "image.pcd", "image.pcd", "out"}), 2);
}

/** \brief Save some points of a view with its pose. */
static void
saveSeenFromThere (const pcl::PointCloud<pcl::PointXYZRGBL>& view, pcl::PointCloud<pcl::PointXYZ> points,
                   const std::string& path)
{
  points.sensor_origin_ = view.sensor_origin_;
  points.sensor_orientation_ = view.sensor_orientation_;
  pcl::io::savePCDFileBinary (path, points);
}

TEST_F (AnyCloud, WrongReadingsAtTheEdgesOfPixelsWithoutTheirOrderAreLeftOut)
{
  writeTableScene (path ("table.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> table;
  pcl::io::loadPCDFile (path ("table.pcd"), table);
  pcl::PointCloud<pcl::PointXYZ> clean;
  for (const pcl::PointXYZRGBL& point : table)
    if (point.label == 1 && point.getVector3fMap ().allFinite ())
      clean.emplace_back (point.x, point.y, point.z);
  pcl::PointCloud<pcl::PointXYZ> mixed = clean;
  for (std::size_t i = 0; i + 1 < table.size (); ++i) // half way from the object's end to what is behind it
    if (const pcl::PointXYZRGBL& end = table[i], &next = table[i + 1];
        end.label == 1 && next.label != 1 && next.z > 1.02f * end.z)
    {
      const float part = 0.5f * (end.z + next.z) / next.z;
      mixed.emplace_back (part * next.x, part * next.y, part * next.z);
    }
  ASSERT_GT (mixed.size (), 1.005 * clean.size ());
  saveSeenFromThere (table, clean, path ("clean.pcd"));
  saveSeenFromThere (table, mixed, path ("mixed.pcd"));
  ASSERT_EQ (run ({"clean.pcd", "clean.ply"}), 0) << errors_;
  EXPECT_EQ (errors_.find ("pixels of an image"), std::string::npos) << errors_;
  ASSERT_EQ (run ({"mixed.pcd", "mixed.ply"}), 0) << errors_;
  EXPECT_NE (errors_.find ("its points are pixels of an image, without their order"), std::string::npos) << errors_;
  EXPECT_NEAR (volume ("mixed.ply"), volume ("clean.ply"), 0.1 * volume ("clean.ply"));
}

/** \brief An object that was cut out by a mask that is a little too large. */
TEST_F (AnyCloud, WhatIsBehindAnObjectThatWasCutOutIsLeftOut)
{
  writeTableScene (path ("table.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> table;
  pcl::io::loadPCDFile (path ("table.pcd"), table);
  pcl::PointCloud<pcl::PointXYZ> exact;
  std::set<std::size_t> behind; // pixels
  for (std::size_t i = 0; i < table.size (); ++i)
    if (const pcl::PointXYZRGBL& point = table[i]; point.label == 1 && point.getVector3fMap ().allFinite ())
    {
      exact.emplace_back (point.x, point.y, point.z);
      for (const std::size_t step : {std::size_t (1), std::size_t (table.width)})
        for (std::size_t k = 1; k <= 3 && i >= k * step; ++k)
          if (const pcl::PointXYZRGBL& next = table[i - k * step]; next.label == 0 && next.z > 1.05f * point.z)
            behind.insert (i - k * step);
    }
  pcl::PointCloud<pcl::PointXYZ> large = exact;
  for (const std::size_t i : behind)
    large.emplace_back (table[i].x, table[i].y, table[i].z);
  saveSeenFromThere (table, exact, path ("exact.pcd"));
  saveSeenFromThere (table, large, path ("large.pcd"));
  ASSERT_EQ (run ({"exact.pcd", "exact.ply"}), 0) << errors_;
  EXPECT_EQ (errors_.find ("apart from the others"), std::string::npos) << errors_;
  ASSERT_EQ (run ({"large.pcd", "large.ply"}), 0) << errors_;
  EXPECT_NE (errors_.find ("of the points are apart from the others, and are left out"), std::string::npos) << errors_;
  EXPECT_NEAR (volume ("large.ply"), volume ("exact.ply"), 0.1 * volume ("exact.ply"));
  EXPECT_LT ((centroid ("large.ply") - centroid ("exact.ply")).norm (), 0.003);
}
