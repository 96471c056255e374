// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_registration.h>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

#define PCL_INSTANTIATE_CosectionSdfRegistration(T) template class pcl::cosection::SdfRegistration<T>;
PCL_INSTANTIATE (CosectionSdfRegistration, (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (
                                               pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
