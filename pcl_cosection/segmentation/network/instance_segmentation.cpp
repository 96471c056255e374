// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/segmentation/impl/instance_segmentation.hpp>
#include <pcl/cosection/segmentation/instance_segmentation.h>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE (CosectionInstanceSegmentation,
                 (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (pcl::PointXYZRGBNormal))
