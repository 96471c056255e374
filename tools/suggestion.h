// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <string>
#include <vector>

/** \brief Of \a names, the one with the smallest edit distance to \a word; the first if several
 * are as near, nothing if there are no names. */
std::string
nearestName (const std::string& word, const std::vector<std::string>& names);
