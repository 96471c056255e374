// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "seed_cloud.h"

#include <string>
#include <utility>
#include <vector>

namespace fuzz {

/** \brief An element of a PLY file: its name and what it holds. */
using PlyElement = std::pair<std::string, Cloud>;

/** \brief The bytes of a PLY file; fields of several elements are lists. \param[in] format as in its header */
std::string plyFile (const std::vector<PlyElement>& elements, const std::string& format);

/** \brief The camera that pcl::PLYWriter puts behind the points; that of points in doubles has its place in these. */
PlyElement cameraOf (const Cloud& cloud);

PlyElement someFaces ();

} // namespace fuzz
