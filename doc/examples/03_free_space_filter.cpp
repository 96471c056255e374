// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Two views of a wall; a point floats in front of it in one of them. The other view looks through that point, so it is
// removed.
#include <pcl/cosection/surface/free_space_filter.h>

#include <pcl/point_types.h>

#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/** \brief What a depth camera one metre in front of a wall sees. */
Cloud
wall ()
{
  Cloud cloud (64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      cloud (u, v) = {(u - 31.5f) / 60.0f, (v - 23.5f) / 60.0f, 1.0f};
  return cloud;
}

int
main ()
{
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity ();
  T_first_second.translation ().x () = 0.1; // the second camera is 10 cm to the right

  auto merged = pcl::make_shared<Cloud> (wall ());
  merged->push_back ({0.0f, 0.0f, 0.5f}); // the floating point
  pcl::cosection::FreeSpaceFilter<pcl::PointXYZ> filter;
  filter.setInputCloud (merged);
  filter.addView (wall ());
  filter.addView (wall (), T_first_second);
  Cloud clean;
  filter.filter (clean);
  std::cout << merged->size () << " points, " << clean.size () << " after the filter\n";
  return clean.size () + 1 == merged->size () ? 0 : 1;
}
