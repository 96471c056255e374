// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/io/pcd_view.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace pcl::cosection::test {

class PcdView : public testing::Test
{
protected:
  std::string path (const std::string& name) const { return (folder_.file (name)); }

  std::string write (const std::string& content, const std::string& name = "cloud.pcd") const
  {
    std::ofstream (path (name), std::ios::binary) << content;
    return (path (name));
  }

  /** \brief The message of the error that reading \a file gives. */
  template <typename Expected> std::string failure (const std::string& file, const PcdViewOptions& options = {}) const
  {
    const std::string message = messageOf<Expected> ([&] { readPcdView (file, options); });
    EXPECT_NE (message.find (file), std::string::npos) << message;
    return (message);
  }

  const TemporaryFolder folder_;
};

/** \brief A header with the float fields x y z and further given fields. */
inline std::string
header (int width, int height, const std::string& data = "ascii", const std::string& fields = "x y z",
        const std::string& size = "4 4 4", const std::string& type = "F F F",
        const std::string& viewpoint = "0 0 0 1 0 0 0")
{
  std::string count;
  for (std::size_t i = 0; i < type.size (); i += 2)
    count += " 1";
  return ("# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT" + count +
          "\nWIDTH " + std::to_string (width) + "\nHEIGHT " + std::to_string (height) + "\nVIEWPOINT " + viewpoint +
          "\nPOINTS " + std::to_string (width * height) + "\nDATA " + data + "\n");
}

/** \brief A plane at depth 1 seen by a pinhole, label 0 on the left and 7 on the right. */
inline pcl::PointCloud<pcl::PointXYZRGBL>
organizedPlane ()
{
  const PinholeCamera camera{64, 48, 60.0, 62.0, 31.0, 24.0};
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
    {
      auto& p = cloud.at (u, v);
      p.getVector3fMap () = camera.unproject (u, v, 1.0).cast<float> ();
      p.r = 10;
      p.g = 20;
      p.b = 30;
      p.label = u < 32 ? 0 : 7;
    }
  return (cloud);
}

/** \brief organizedPlane () with a step in depth, so that its pixels determine the sensor's pose. */
inline pcl::PointCloud<pcl::PointXYZRGBL>
organizedStep ()
{
  pcl::PointCloud<pcl::PointXYZRGBL> cloud = organizedPlane ();
  for (int v = 0; v < 24; ++v)
    for (int u = 0; u < 64; ++u)
      cloud.at (u, v).getVector3fMap () *= 1.2f;
  return (cloud);
}

inline void
moveBy (const Eigen::Isometry3f& T, pcl::PointCloud<pcl::PointXYZRGBL>& cloud)
{
  for (auto& p : cloud)
    p.getVector3fMap () = T * Eigen::Vector3f (p.getVector3fMap ());
}

} // namespace pcl::cosection::test
