// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mask_image.h"
#include <pcl/cosection/common/image.h>

#include <cstdint>
#include <string>

namespace pcl::cosection {

/** \brief Write colours as PNG, or what else the file's name ends in. \throws IoError */
void saveColourImage (const Picture& picture, const std::string& path);

/** \brief Write depth (metres, NaN: no reading). A name that ends in .exr gives one 32-bit floating-point channel in
 * metres, with NaN as 0; .png gives 16 bits, depth * \a scale, with 0 where there is no reading or more than fits.
 * \throws IoError, InvalidArgument for another name */
void saveDepthImage (const Image<float>& depth, const std::string& path, double scale = 1000.0);

/** \brief Read what saveDepthImage () writes, or floating-point depth in three equal channels. \return metres; NaN: no
 * reading, of whole numbers 0 and 65535, which is what did not fit
 * \throws IoError naming the file, if it cannot be read, is damaged, or is no depth image */
Image<float> loadDepthImage (const std::string& path, double scale = 1000.0);

/** \brief Write ids of instances as PNG, with 16 bits if \a wide, else with 8. \throws IoError, InvalidArgument if an
 * id does not fit */
void saveMaskImage (const Image<std::uint16_t>& mask, const std::string& path, bool wide = false);

/** \brief Read a colour image. \throws IoError */
Picture loadColourImage (const std::string& path);

} // namespace pcl::cosection
