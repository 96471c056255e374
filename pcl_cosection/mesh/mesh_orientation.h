// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection {

/** \brief Turn triangles so that neighbours across edges of two agree, the fewest that do, and so that closed
 * parts face outward: all of them if their volumes sum up to less than nothing, then each whose volume is
 * negative unless it is a cavity in another. Where a surface has one side only (a Moebius strip), two
 * neighbours keep disagreeing. */
void orientTriangles (TriangleMesh& mesh);

} // namespace pcl::cosection
