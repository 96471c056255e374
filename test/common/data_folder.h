// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace pcl::cosection::test {

/** \brief A folder of the shared data in $PCL_COSECTION_DATA, or by default in ../shared/data beside the checkout. It
 * need not exist. */
std::filesystem::path dataFolder (const std::string& name);

} // namespace pcl::cosection::test
