// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "labelled_cloud.h"

#include "pcl_cosection/common/atomic_file.h"
#include <pcl/cosection/common/error.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>

namespace pcl::cosection {

void
saveLabelledCloud (const DepthView& view, const Image<std::uint16_t>& labels, const Picture& colours,
                   const std::string& path)
{
  view.validate ();
  if (labels.pixels.size () != view.depth.size () || colours.pixels.size () != view.depth.size ())
    throw InvalidArgument (path + ": there must be one label and one colour per pixel");
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (view.camera.width, view.camera.height);
  cloud.is_dense = false;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
    {
      pcl::PointXYZRGBL& point = cloud (u, v);
      const float z = view.at (u, v);
      if (std::isfinite (z))
        point.getVector3fMap () = view.camera.unproject (u, v, z).cast<float> ();
      else
        point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN ();
      const auto& colour = colours.at (u, v);
      point.r = colour[0];
      point.g = colour[1];
      point.b = colour[2];
      point.a = 255;
      point.label = labels.at (u, v);
    }
  cloud.sensor_origin_.head<3> () = view.T_world_sensor.translation ().cast<float> ();
  cloud.sensor_orientation_ = Eigen::Quaternionf (view.T_world_sensor.linear ().cast<float> ());
  writeAtomically (path, [&] (const std::string& temporary) {
    bool written = false;
    try
    {
      written = pcl::PCDWriter ().writeBinaryCompressed (temporary, cloud) == 0;
    }
    catch (const std::exception&)
    {
      // reported below
    }
    if (!written)
      throw IoError (path + ": cannot be written");
  });
}

} // namespace pcl::cosection
