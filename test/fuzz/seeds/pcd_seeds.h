// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/** \brief Small PCD and PLY files of every kind: organised or not, in every encoding, with colours, labels, normals,
 * doubles, survey coordinates, fields of several elements, padding and comments, cameras and faces; unorganised ones
 * seen from a viewpoint, not from theirs, or from nowhere. */
std::vector<std::string> pcdSeeds ();

} // namespace fuzz
