// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/** \brief The description of a scene: six things of random kinds, sizes and poses on a table, some hidden in part by
 * others, and a camera that sees them from so many sides in turn; with a camera's noise. */
std::string randomTable (unsigned seed, int views);
