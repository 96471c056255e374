// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

namespace pcl::cosection::test {

/** \brief An organised cloud of level surfaces across the view, with labels, all 0 at first. */
class LabelledImage : public testing::Test
{
protected:
  LabelledImage (int width, int height, float focal_px) : focal_px_ (focal_px)
  {
    cloud_.resize (static_cast<std::size_t> (width) * height);
    cloud_.width = width;
    cloud_.height = height;
  }

  /** \brief A rectangle of pixels, without those at its right and at its bottom, at one depth. */
  void set (int left, int right, int top, int bottom, float depth_m)
  {
    for (int v = top; v < bottom; ++v)
      for (int u = left; u < right; ++u)
      {
        pcl::PointXYZL& p = cloud_.at (u, v);
        p.x = (static_cast<float> (u) - 0.5f * static_cast<float> (cloud_.width - 1)) / focal_px_ * depth_m;
        p.y = (static_cast<float> (v) - 0.5f * static_cast<float> (cloud_.height - 1)) / focal_px_ * depth_m;
        p.z = depth_m;
      }
  }

  void label (int left, int right, int top, int bottom, std::uint32_t label)
  {
    for (int v = top; v < bottom; ++v)
      for (int u = left; u < right; ++u)
        cloud_.at (u, v).label = label;
  }

  /** \param[in] given whether the labels are given beside the file */
  LabelledView read (bool given = false) const
  {
    PcdViewOptions options;
    for (const pcl::PointXYZL& point : cloud_)
      if (given)
        options.labels.push_back (point.label);
    const std::string path = folder_.file ("cloud.pcd");
    pcl::io::savePCDFileBinary (path, cloud_);
    return readPcdView (path, options);
  }

private:
  pcl::PointCloud<pcl::PointXYZL> cloud_;
  float focal_px_;
  TemporaryFolder folder_;
};

} // namespace pcl::cosection::test
