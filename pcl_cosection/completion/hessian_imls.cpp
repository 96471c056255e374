// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/hessian_imls.h>
#include <pcl/cosection/surface/impl/hessian_imls.hpp>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE (CosectionHessianIMLS, (pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
