// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>

#include <cstdint>
#include <string>

namespace pcl::cosection {

/** \brief Write a depth view as an organised PCD file with the fields x y z rgb label: points in the sensor frame, NaN
 * where there is no reading, and the sensor's pose as VIEWPOINT. readPcdView () reads it.
 * \param[in] labels one per pixel \param[in] colours one per pixel
 * \throws IoError, InvalidArgument if the sizes differ */
void saveLabelledCloud (const DepthView& view, const Image<std::uint16_t>& labels, const Picture& colours,
                        const std::string& path);

} // namespace pcl::cosection
