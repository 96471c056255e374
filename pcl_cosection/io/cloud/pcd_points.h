// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcd_header.h"

#include <pcl/PCLPointCloud2.h>

#include <string>

namespace pcl::cosection {

/** \brief Read the points that \a header, from readPcdHeader (), describes.
 *
 * pcl::PCDReader is not used: it reads the header again by rules of its own, for example lines of it that
 * stand in the wrong order or among the points, and then writes beyond the points' memory.
 *
 * \return the fields of the header (of a compressed file, those that are no padding) and the bytes of
 * the points; its other members are not set
 * \throws IoError if the points are not what the header announces */
PCLPointCloud2 readPcdPoints (const std::string& path, const PcdHeader& header);

} // namespace pcl::cosection
