// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/free_space_filter.h>
#include <pcl/cosection/surface/impl/free_space_filter.hpp>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE (CosectionFreeSpaceFilter,
                 (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (
                     pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
