// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace pcl::cosection::test {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN ();

} // namespace pcl::cosection::test
