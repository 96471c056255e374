// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/free_space_filter.h>

#include <pcl/point_types.h>

#include <iostream>

/** \brief A wall across the view of a sensor at the origin. */
pcl::PointCloud<pcl::PointXYZ>
wall (float distance_m)
{
  pcl::PointCloud<pcl::PointXYZ> cloud (64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      cloud (u, v) = {(u - 31.5f) / 60.0f * distance_m, (v - 23.5f) / 60.0f * distance_m, distance_m};
  return cloud;
}

int
main ()
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> (wall (1.0f));
  cloud->push_back ({0.0f, 0.0f, 0.5f}); // in front of it
  pcl::cosection::FreeSpaceFilter<pcl::PointXYZ> filter;
  filter.setInputCloud (cloud);
  filter.addView (wall (1.0f));
  pcl::PointCloud<pcl::PointXYZ> clean;
  filter.filter (clean);
  std::cout << "a wall and a ghost: " << cloud->size () << " points, " << clean.size () << " without the ghost\n";
  return clean.size () + 1 == cloud->size () ? 0 : 1;
}
