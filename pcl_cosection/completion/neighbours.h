// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief For each object, in ascending order, the others whose volumes may meet its own: their boxes in the world do,
 * at any of their poses. */
std::vector<std::vector<std::size_t>> neighboursOf (const std::vector<SceneObject>& objects);

} // namespace pcl::cosection
