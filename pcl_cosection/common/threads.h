// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

namespace pcl::cosection {

/** \brief How many of \a wanted threads, at least 1, the calling thread's next parallel region can have.
 *
 * Where a thread cannot be made, OpenMP's library ends the process by exit (), while other threads still run. Therefore
 * as many as it will make are made and joined before. It keeps those of the last region, which are not tried again.
 * A region that other code opens with more threads than the last one that asked here is not known. */
PCL_COSECTION_EXPORT int obtainableThreads (int wanted);

} // namespace pcl::cosection
