// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/** \brief The one of \a names with the smallest edit distance to \a word; the first if several
 * are as near, nothing if none is near. */
std::string nearestName (const std::string& word, const std::vector<std::string>& names);

/** \brief "; did you mean NAME?" of the nearest name, without dashes if \a bare; nothing if none is near. */
std::string suggestion (const std::string& word, const std::vector<std::string>& names, bool bare = false);
