// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Real views of objects on a table, with labels drawn by hand.

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "common/data_folder.h"
#include "label_comparison.h"

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (ObjectSegmentationData, ObjectsOfTheDatabase)
{
  std::error_code absent;
  double sum = 0.0;
  int objects = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator (dataFolder ("osd"), absent))
  {
    pcl::PointCloud<pcl::PointXYZL> cloud;
    if (entry.path ().extension () != ".pcd" || pcl::io::loadPCDFile (entry.path ().string (), cloud) != 0)
      continue;
    std::vector<Eigen::Vector3f> points;
    std::vector<std::uint32_t> truth;
    std::vector<char> valid;
    for (const pcl::PointXYZL& p : cloud)
    {
      points.push_back (p.getVector3fMap ());
      truth.push_back (p.label);
      valid.push_back (std::isfinite (p.z));
    }
    const ObjectSegmentation found = segmentObjects (points, static_cast<int> (cloud.width),
                                                     static_cast<int> (cloud.height));
    const LabelComparison comparison = compareLabels (truth, found.labels, valid);
    EXPECT_LE (comparison.background_pixels, 2000u) << entry.path ();
    EXPECT_GE (comparison.mean_iou, 0.8) << entry.path ();
    for (const auto& [object, iou] : comparison.best_iou)
    {
      sum += iou;
      ++objects;
    }
  }
  if (objects == 0)
    GTEST_SKIP () << "no views in " << dataFolder ("osd").string ()
                  << "; PCL_COSECTION_DATA can name the folder of the shared data";
  EXPECT_GE (sum / objects, 0.85);
}
