// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Whether a mesh has vertices alone, as a scan: it is a set of points. */
bool isPointSet (const TriangleMesh& mesh);

/** \brief \throws InvalidArgument if a vertex of a set of points is not finite */
void requirePoints (const TriangleMesh& points);

/** \brief The distance of each of \a from to the nearest vertex of a set of points, metres; by pcl::search::KdTree.
 * \param[in] neighbour 1: the nearest vertex, 2: the second nearest
 * \throws InvalidArgument if a vertex is not finite \throws DegenerateInput if there are fewer vertices */
std::vector<double> distancesToPoints (const TriangleMesh& points, const std::vector<Eigen::Vector3d>& from,
                                       int neighbour = 1, int threads = 0);

/** \brief At most \a count vertices, evenly along their order. */
std::vector<Eigen::Vector3d> somePoints (const TriangleMesh& points, std::size_t count);

/** \brief The median distance of a vertex to the nearest other one, metres. */
double spacingOf (const TriangleMesh& points, int threads = 0);

} // namespace pcl::cosection
