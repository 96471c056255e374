// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <functional>
#include <string>

namespace pcl::cosection
{

/** \brief Called now and then with the name of the running stage and the finished fraction of the
 * whole work in [0, 1], always from the calling thread. Returning false cancels: the running call
 * throws Cancelled and leaves nothing half-written. */
using ProgressCallback = std::function<bool (const std::string& stage, double fraction)>;

} // namespace pcl::cosection
