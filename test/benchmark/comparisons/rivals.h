// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <vector>

// What PCL makes of the same oriented points: to compare with.

namespace pcl::cosection::test {

/** \brief pcl::Poisson of depth 6, otherwise its defaults. */
TriangleMesh poissonSurface (const std::vector<OrientedPoint>& points);

/** \brief pcl::ConvexHull, facing outward. */
TriangleMesh convexHull (const std::vector<OrientedPoint>& points);

/** \brief pcl::MarchingCubesHoppe on 50 cells along each axis, a tenth beyond the points, otherwise its defaults. */
TriangleMesh hoppeSurface (const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection::test
