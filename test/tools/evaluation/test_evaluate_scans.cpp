// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Evaluation against scans: points without faces.

#include "common/small_meshes.h"
#include "evaluate_fixture.h"

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST_F (Evaluate, TruthMayBeAScan)
{
  const TriangleMesh box = boxMesh ({-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f});
  save ("box.ply", box);
  pcl::PointCloud<pcl::PointXYZ> points;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      for (const float side : {-1.0f, 1.0f})
        for (int axis = 0; axis < 3; ++axis)
        {
          Eigen::Vector3f at (0.1f * i - 1.0f, 0.1f * j - 1.0f, side);
          std::swap (at[2], at[axis]);
          at *= 0.05f;
          points.emplace_back (at.x (), at.y (), at.z () + 0.001f);
        }
  pcl::io::savePLYFileBinary (folder_.file ("scan.ply"), points);
  pcl::io::savePCDFileBinary (folder_.file ("scan.pcd"), points);
  for (const std::string scan : {"scan.ply", "scan.pcd"})
  {
    ASSERT_EQ (run ({"mesh", "--json", "s.json", "--error-mesh", "e.ply", scan, "box.ply"}), 0) << errors_;
    EXPECT_LT (json ("s.json")["completeness_m"].get<double> (), 0.001);
    EXPECT_LT (json ("s.json")["accuracy_m"].get<double> (), 0.004);
    EXPECT_NEAR (json ("s.json")["truth"]["point_spacing_m"].get<double> (), 0.005, 1e-4);
    EXPECT_NE (output_.find ("the truth is a set of points, 5"), std::string::npos) << output_;
    ASSERT_EQ (run ({"mesh", "box.ply", scan}), 0) << errors_;
    EXPECT_EQ (run ({"mesh", "--error-picture", "e.png", scan, "box.ply"}), 2);
    expectOneLine ("--error-picture needs meshes, and " + scan + " holds points alone");
  }
  ASSERT_EQ (run ({"mesh", "--align", "icp", "--json", "s.json", "scan.ply", "box.ply"}), 0) << errors_;
  EXPECT_LT (json ("s.json")["completeness_m"].get<double> (), 0.0002); // moved by the millimetre
}
