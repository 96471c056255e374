// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/** \brief The pixels of --ignore-region and --ignore-mask.
 * \param[in] regions x, y, width, height, pixels \param[in] mask file; empty: none
 * \return 1: to be ignored; empty if nothing is
 * \throws UsageError if a region is not within the image \throws pcl::cosection::IoError if the mask cannot be read, or has another size */
pcl::cosection::Image<std::uint8_t>
ignoredPixels (const pcl::cosection::PinholeCamera& camera, const std::vector<std::array<double, 4>>& regions, const std::string& mask);
