// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pcl::cosection {

/** \brief Check what OpenCV's importer of ONNX believes: that each tensor has as much data as its dimensions say, that
 * sizes and numbers of groups are positive, and that nodes use what comes before them. What it believes wrongly it
 * reads beyond the end of, which may go unnoticed. The tensors are those that OpenCV sees, as its encoding is read by
 * the same library.
 * \param[in] bytes contents of a file \throws IoError saying what is wrong with them */
void checkOnnx (const std::string& bytes);

} // namespace pcl::cosection
