// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_segment as a user calls it.

#include "tool_run.h"

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

constexpr int width = 160, height = 120;

class Segment : public ToolTest
{
protected:
  using Cloud = pcl::PointCloud<pcl::PointXYZRGBL>;

  /** \brief Seen from above, 0.8 m away: a table, and a block of 10 x 10 x 6 cm on it. */
  Segment () : ToolTest (PCL_COSECTION_SEGMENT)
  {
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
      {
        const float x = static_cast<float> (u - width / 2) / 130.0f, y = static_cast<float> (v - height / 2) / 130.0f;
        float z = 0.8f;
        if (std::max (std::abs (x), std::abs (y)) * 0.74f < 0.05f)
          z = 0.74f;
        pcl::PointXYZRGBL& p = cloud_ (u, v);
        p.getVector3fMap () = Eigen::Vector3f (x * z, y * z, z);
        p.rgba = static_cast<std::uint32_t> (0xff000000u + u * 256 + v);
        p.label = 7;
      }
    cloud_.sensor_origin_ = Eigen::Vector4f (1, 2, 3, 0);
    cloud_.sensor_orientation_ = Eigen::Quaternionf (0, 1, 0, 0);
    save (cloud_);
  }

  void save (const Cloud& cloud) const { pcl::io::savePCDFileBinary (path ("in.pcd"), cloud); }

  Cloud cloud_{width, height};
};

} // namespace

TEST_F (Segment, LabelsAndKeepsTheRest)
{
  ASSERT_EQ (run ({"in.pcd", "out.pcd", "--json", "s.json"}), 0) << errors_;
  EXPECT_EQ (errors_, "");
  EXPECT_EQ (output_, "wrote out.pcd: 1 object on 1 plane\n");
  Cloud out;
  ASSERT_EQ (pcl::io::loadPCDFile (path ("out.pcd"), out), 0);
  ASSERT_EQ (out.width, cloud_.width);
  ASSERT_EQ (out.height, cloud_.height);
  EXPECT_EQ (out.sensor_origin_.head<3> (), cloud_.sensor_origin_.head<3> ());
  EXPECT_TRUE (out.sensor_orientation_.isApprox (cloud_.sensor_orientation_));
  std::size_t wrong = 0, points = 0;
  for (std::size_t i = 0; i < out.size (); ++i)
  {
    EXPECT_EQ (out[i].getVector3fMap (), cloud_[i].getVector3fMap ());
    EXPECT_EQ (out[i].rgba, cloud_[i].rgba);
    wrong += (out[i].label == 1) != (out[i].z < 0.77f);
    points += out[i].label == 1;
  }
  EXPECT_EQ (wrong, 0u);
  const nlohmann::json summary = json ("s.json");
  ASSERT_EQ (summary["objects"].size (), 1u);
  EXPECT_EQ (summary["objects"][0]["label"], 1);
  EXPECT_EQ (summary["objects"][0]["points"], points);
  EXPECT_NEAR (std::abs (summary["support_planes"][0][3].get<double> ()), 0.8, 0.002);
  EXPECT_GT (summary["timings_s"]["total"], 0.0);
}

TEST_F (Segment, LeavesOutARegion)
{
  ASSERT_EQ (run ({"in.pcd", "out.pcd", "--ignore-region", "60,0,40,120"}), 0) << errors_; // that the block is in
  EXPECT_EQ (output_, "wrote out.pcd: 0 objects on 1 plane\n");
  Cloud out;
  ASSERT_EQ (pcl::io::loadPCDFile (path ("out.pcd"), out), 0);
  EXPECT_EQ (out (width / 2, height / 2).label, 65535u);
  EXPECT_EQ (out (3, 3).label, 0u);
}

TEST_F (Segment, NoObjectIsAFailureThatSaysWhatMayHelp)
{
  EXPECT_EQ (run ({"in.pcd", "out.pcd", "--json", "s.json", "--min-object-size", "0.3"}), 1);
  EXPECT_EQ (output_, "wrote out.pcd: 0 objects on 1 plane\n");
  EXPECT_EQ (errors_, "pcl_cosection_segment: error: in.pcd: no object was found; objects are 0.3 to 0.5 m long "
                      "(--min-object-size, --max-object-size), and stand on the 1 plane that it shows; is "
                      "the unit the metre (else --scale 0.001)?\n");
  EXPECT_TRUE (json ("s.json")["objects"].empty ());
}

TEST_F (Segment, AddsTheFieldInMillimetres)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::copyPointCloud (cloud_, cloud);
  for (pcl::PointXYZ& p : cloud)
    p.getVector3fMap () *= 1000.0f;
  pcl::io::savePCDFileASCII (path ("in.pcd"), cloud);
  ASSERT_EQ (run ({"in.pcd", "out.pcd", "--scale", "0.001", "--quiet"}), 0) << errors_;
  EXPECT_EQ (output_, "");
  pcl::PointCloud<pcl::PointXYZL> out;
  ASSERT_EQ (pcl::io::loadPCDFile (path ("out.pcd"), out), 0);
  EXPECT_EQ (out (width / 2, height / 2).label, 1u);
  EXPECT_NEAR (out (width / 2, height / 2).z, 740.0f, 0.1f);
  EXPECT_EQ (out (3, 3).label, 0u);
}

TEST_F (Segment, PclCosectionTakesIt)
{
  ASSERT_EQ (run ({"in.pcd", "out.pcd"}), 0) << errors_;
  EXPECT_EQ (run ({"out.pcd", "meshes", "--resolution", "24"}, {}, PCL_COSECTION_TOOL), 0) << errors_;
  EXPECT_TRUE (fs::exists (path ("meshes/object_1.ply")));
}

TEST_F (Segment, WrongUsageIsOneLine)
{
  EXPECT_NE (failure ({}, 2).find ("missing"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd"}, 2).find ("OUTPUT.pcd is missing"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "more"}, 2).find ("more"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "meshes"}, 2).find (".pcd"), std::string::npos);
  EXPECT_NE (failure ({"", "out.pcd"}, 2).find ("INPUT is empty"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "in.pcd"}, 2).find ("in.pcd"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--json", "in.pcd"}, 2).find ("in.pcd"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--max-object-sise", "1"}, 2).find ("--max-object-size"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--max-object-size", "-1"}, 2).find ("--max-object-size"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--min-object-size", "1"}, 2).find ("--min-object-size"),
             std::string::npos);
}

TEST_F (Segment, BadInputIsOneLine)
{
  EXPECT_NE (failure ({"absent.pcd", "out.pcd"}, 1).find ("absent.pcd"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "no/folder/out.pcd"}, 1).find ("no/folder"), std::string::npos);
  Cloud changed = cloud_;
  changed.width = width * height;
  changed.height = 1;
  save (changed);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--ignore-region", "0,0,9,9"}, 1).find ("in.pcd: is not organised"),
             std::string::npos);
  changed = cloud_;
  for (auto& p : changed)
    p.z += 5.0f * (p.x * p.x + p.y * p.y);
  save (changed);
  EXPECT_NE (failure ({"in.pcd", "out.pcd"}, 1).find ("in.pcd: no plane in view"), std::string::npos);
  for (auto& p : changed)
    p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN ();
  save (changed);
  EXPECT_NE (failure ({"in.pcd", "out.pcd"}, 1).find ("in.pcd: holds no finite point"), std::string::npos);
}
