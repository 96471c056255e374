// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pcl::cosection {

/** \brief Whether bytes begin as a PNG does but its chunks are cut short, have wrong checksums, or claim an image of
 * absurd size. Libraries print lines of their own about such files, or crash. */
PCL_COSECTION_EXPORT bool isDamagedPng (std::string_view bytes);

/** \brief Read ids of instances from a PNG of 8 or 16 bits: of one channel, of several equal ones, or of a palette,
 * whose numbers they are; transparency is not used. \throws IoError */
PCL_COSECTION_EXPORT Image<std::uint16_t> loadMaskImage (const std::string& path);

} // namespace pcl::cosection
