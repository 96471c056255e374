// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_file.h"
#include "sensor_cloud.h"

#include <string>

namespace pcl::cosection {

/** \brief Read the labels of a cloud whose positions are read: those of the field that is wanted, or of label, or of
 * one of the names that other programs give it.
 *
 * Labels of the background become 0, and points that are to be ignored lose their position. \a cloud.warnings says
 * which field is taken, or which others look like labels if none is, and what a label has become.
 * \throws IoError if the wanted field is missing or holds no labels */
void readLabels (const std::string& path, const CloudHeader& header, const PCLPointCloud2& points,
                 const PcdViewOptions& options, SensorCloud& cloud);

} // namespace pcl::cosection
