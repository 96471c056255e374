// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_registration.h>

#include <pcl/point_types.h>

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::SdfRegistration, PCL_COSECTION_XYZ_POINT_TYPES)
