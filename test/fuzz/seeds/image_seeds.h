// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/** \brief Small colour and depth images in all formats that are read: PNG, JPEG, TIFF, BMP, EXR and PNM. */
std::vector<std::string> imageSeeds ();

} // namespace fuzz
