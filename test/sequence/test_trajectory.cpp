// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

#include <gtest/gtest.h>

#include <fstream>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class Trajectory : public testing::Test
{
protected:
  std::vector<StampedPose> load (const std::string& text) const
  {
    const std::string path = folder_.file ("poses.txt");
    std::ofstream (path, std::ios::binary) << text;
    return loadTrajectory (path);
  }

  std::string failure (const std::string& text) const
  {
    return messageOf<IoError> ([&] { load (text); });
  }

  TemporaryFolder folder_;
};

} // namespace

TEST_F (Trajectory, ReadsPosesByAscendingStamps)
{
  const auto poses = load ("# stamp tx ty tz qx qy qz qw\n\n2.5 1 2 3 0 0 0 1\r\n  1 -1e-1 0 0  0 0 2 2\n");
  ASSERT_EQ (poses.size (), 2u);
  EXPECT_EQ (poses[0].stamp, 1.0);
  EXPECT_EQ (poses[1].stamp, 2.5);
  EXPECT_LT ((poses[1].pose.translation () - Eigen::Vector3d (1, 2, 3)).norm (), 1e-12);
  EXPECT_LT ((poses[0].pose * Eigen::Vector3d (1, 0, 0) - Eigen::Vector3d (-0.1, 1, 0)).norm (),
             1e-9); // a quarter turn
  EXPECT_LT ((poses[0].pose.linear () * poses[0].pose.linear ().transpose () - Eigen::Matrix3d::Identity ()).norm (),
             1e-12);
}

TEST_F (Trajectory, NamesTheLineThatIsWrong)
{
  EXPECT_NE (failure ("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0\n").find ("line 2"), std::string::npos);
  EXPECT_NE (failure ("0 0 0 0 0 0 0 1 5\n").find ("line 1"), std::string::npos);
  EXPECT_NE (failure ("0 0 0 0 0 0 0 0\n").find ("quaternion"), std::string::npos);
  EXPECT_NE (failure ("0 0 0 0 0 1e200 0 1\n").find ("quaternion"), std::string::npos); // its square is infinite
  EXPECT_NE (failure ("0 0 x 0 0 0 0 1\n").find ("line 1"), std::string::npos);
  EXPECT_NE (failure ("0 0 0 0 0 0 0 1\n1 0 0 0\n").find ("line 2: has 4 numbers; a pose is 'stamp tx"),
             std::string::npos);
  EXPECT_NE (failure ("-1e18 0 0 0 0 0 0 1\n").find ("line 1: has a stamp that is no time"), std::string::npos);
  EXPECT_NE (failure ("inf 0 0 0 0 0 0 1\n").find ("line 1: has a stamp that is no time"), std::string::npos);
  EXPECT_NE (failure ("0 nan 0 0 0 0 0 1\n").find ("no poses that are finite"), std::string::npos);
  EXPECT_NE (failure ("# nothing\n").find ("no poses"), std::string::npos);
  EXPECT_NE (failure ("3 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n").find ("two poses of stamp 3"), std::string::npos);
  EXPECT_THROW (loadTrajectory (folder_.file ("missing.txt")), IoError);
}

TEST_F (Trajectory, LostPosesAreNone)
{
  const auto poses = load ("0 1 0 0 0 0 0 1\n1 nan nan nan nan nan nan nan\n2 0 0 0 0 0 0 -inf\n3 3 0 0 0 0 0 1\n");
  ASSERT_EQ (poses.size (), 2u);
  EXPECT_EQ (poses[1].stamp, 3.0);
}

TEST_F (Trajectory, StampsMayBeNanoseconds)
{
  const auto poses = load ("1305031102175304000 1 0 0 0 0 0 1\n1305031102275304000 2 0 0 0 0 0 1\n");
  EXPECT_NEAR (poses.at (1).stamp, 1305031102.275304, 1e-6);
}

TEST_F (Trajectory, MatricesAreOfTheFramesInTheirOrder)
{
  const std::string rows = "0 -1 0 1  1 0 0 2  0 0 1 3", lost = "nan nan nan nan nan nan nan nan nan nan nan nan";
  const std::string file = folder_.file ("matrices.txt");
  std::ofstream (file) << rows + "\n" + lost + "\n" + rows + "\n";
  const auto poses = loadTrajectory (file, {5.0, 6.0, 7.0});
  ASSERT_EQ (poses.size (), 2u);
  EXPECT_EQ (poses[1].stamp, 7.0);
  EXPECT_LT ((poses[0].pose * Eigen::Vector3d (1, 0, 0) - Eigen::Vector3d (1, 3, 3)).norm (), 1e-12);
  EXPECT_EQ (loadTrajectory (file).at (1).stamp, 2.0);
  EXPECT_EQ (load (rows + "  0 0 0 1\n").size (), 1u);
  EXPECT_THROW (loadTrajectory (file, {5.0, 6.0}), IoError); // which is whose?
  EXPECT_NE (failure (rows + "\n0 0 0 0 0 0 0 1\n").find ("line 2"), std::string::npos);
  EXPECT_NE (failure ("0 -1 0 1  1 0 0 2  0 0 2 3\n").find ("not a rotation"), std::string::npos);
}

TEST_F (Trajectory, QuaternionsOfAnyLengthAreRotations)
{
  for (const char* line :
       {"0 1 2 3 0 0 0.6 0.8", "0 1 2 3 0 0 0.606 0.808", "0 1 2 3 0 0 6 8", "0 1 2 3 0 0 -0.06 -0.08"})
  {
    const Eigen::Isometry3d pose = load (line).at (0).pose;
    EXPECT_LT ((pose * Eigen::Vector3d (1, 0, 0) - Eigen::Vector3d (1.28, 2.96, 3)).norm (), 1e-12) << line;
  }
}

TEST_F (Trajectory, WhatIsSavedIsLoaded)
{
  const TemporaryFolder folder;
  std::vector<StampedPose> poses (3);
  poses[1].stamp = 1.25;
  poses[1].pose = Eigen::Translation3d (0.1, -2.0, 1e-5) *
                  Eigen::AngleAxisd (2.5, Eigen::Vector3d (1, -2, 0.5).normalized ());
  poses[2].stamp = 1305031102.175304;
  saveTrajectory (poses, folder.file ("t.txt"));
  const std::vector<StampedPose> read = loadTrajectory (folder.file ("t.txt"));
  ASSERT_EQ (read.size (), 3u);
  for (std::size_t n = 0; n < 3; ++n)
  {
    EXPECT_NEAR (read[n].stamp, poses[n].stamp, 1e-6);
    EXPECT_TRUE (read[n].pose.isApprox (poses[n].pose, 1e-8));
  }
  std::ifstream in (folder.file ("t.txt"));
  std::string line;
  std::getline (in, line);
  EXPECT_EQ (line.rfind ("0 0.0", 0), 0u) << line;
  EXPECT_THROW (saveTrajectory (poses, folder.file ("no/t.txt")), IoError);
}
