// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief By pixel of a view, the object (id), or 0 for the background, of whose points one lies nearest to the
 * reading, within the noise; FreeSpaceView::unknown_body where there is none, as between the points of a thinned cloud.
 * Points that were added after another view are not asked. O (points) */
std::vector<int> bodiesShown (const Scene& scene, std::size_t view);

} // namespace pcl::cosection
