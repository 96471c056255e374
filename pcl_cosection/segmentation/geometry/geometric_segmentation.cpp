// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/segmentation/geometric_segmentation.h>
#include <pcl/cosection/segmentation/impl/geometric_segmentation.hpp>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE (CosectionGeometricSegmentation,
                 (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (
                     pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
