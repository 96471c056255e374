// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/segmentation/impl/motion_segmentation.hpp>
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE (CosectionMotionSegmentation,
                 (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (
                     pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
