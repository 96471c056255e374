// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/** \brief Small masks in PNG: one channel of 1 to 16 bits, several equal ones, with and without transparency, palettes,
 * interlaced, with further chunks. */
std::vector<std::string> maskSeeds ();

/** \brief A PNG whose chunks are whole: lengths that leave the file are cut, checksums are right, and it ends with
 * IEND. Else changes of it would not come further than to the checksums. */
std::string withWholeChunks (const std::string& png);

} // namespace fuzz
