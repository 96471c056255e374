// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <string>

namespace pcl::cosection {

/** \brief Read "fx fy cx cy [width height]", in pixels; lines that begin with # are skipped.
 * \return of size 0 x 0 if the file has none
 * \throws IoError if it cannot be read or is no plausible camera */
PinholeCamera readCalibration (const std::string& path);

/** \brief What is implausible about a camera, whose size may be 0 (unknown); empty if nothing is. */
std::string implausibleIntrinsics (const PinholeCamera& camera);

} // namespace pcl::cosection
