// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <boost/preprocessor/seq/for_each.hpp>

namespace pcl {
struct PointXYZ;
struct PointXYZI;
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointXYZRGBL;
struct PointNormal;
struct PointXYZRGBNormal;
struct PointXYZINormal;
} // namespace pcl

/** \brief Points for which the classes that need positions are compiled into the library. */
#define PCL_COSECTION_XYZ_POINT_TYPES                                                                                  \
  (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (pcl::PointNormal) (     \
      pcl::PointXYZRGBNormal) (pcl::PointXYZINormal)

/** \brief Points with normals, see PCL_COSECTION_XYZ_POINT_TYPES. */
#define PCL_COSECTION_NORMAL_POINT_TYPES (pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal)

/** \brief Points with colours, see PCL_COSECTION_XYZ_POINT_TYPES. */
#define PCL_COSECTION_RGB_POINT_TYPES                                                                                  \
  (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (pcl::PointXYZRGBNormal)

/** \brief Declares that a class template is compiled for one of these types. */
#define PCL_COSECTION_EXTERN_TEMPLATE(r, CLASS, TYPE) extern template class PCL_COSECTION_EXPORT CLASS<TYPE>;

/** \brief Compiles a class template for one of these types. */
#define PCL_COSECTION_TEMPLATE(r, CLASS, TYPE) template class CLASS<TYPE>;
