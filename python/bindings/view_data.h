// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arrays.h"

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>

#include <pybind11/pybind11.h>

#include <array>
#include <optional>
#include <string>

/** \brief One view of a scene as the library reads it: a cloud, organised if it was an image. */
struct ViewData
{
  pcl::PCLPointCloud2 cloud; ///< empty: a file is named
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity ();
  std::string file;
};

/** \brief An array that may be None. */
template <typename Scalar> using OptionalArray = std::optional<DenseArray<Scalar>>;

/** \brief The points of a depth image, with NaN where there is no reading.
 * \param[in] depth height x width, metres \param[in] labels height x width \param[in] colours height x width x 3
 * \param[in] pose 4 x 4, T_world_sensor */
ViewData viewOfDepth (const DenseArray<float>& depth, const OptionalArray<std::uint32_t>& labels,
                      const OptionalArray<std::uint8_t>& colours, const std::array<double, 4>& intrinsics,
                      const DenseArray<double>& pose);

/** \brief Points as they are: n x 3, or height x width x 3 of an organised cloud; of floats or doubles. The other
 * arrays have the same number of rows. */
ViewData viewOfPoints (const pybind11::array& points, const OptionalArray<std::uint32_t>& labels,
                       const OptionalArray<std::uint8_t>& colours, const OptionalArray<float>& normals,
                       const DenseArray<double>& pose);
