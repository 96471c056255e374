// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace pcl::cosection
{

/** \brief Share in [0, 1] of the directions of space in which the outermost points of a cloud have normals that point
 * outward, weighted by how clearly they do: near 1 for a body or a part of one, near 0 if its normals are flipped,
 * about one half where the points do not tell, as for a flat piece.
 * \param[in] points metres \param[in] normals one per point; those that are not finite are left out
 * \throws InvalidArgument if there is not one normal per point */
PCL_COSECTION_EXPORT double outwardShare (const std::vector<Eigen::Vector3f>& points,
                                          const std::vector<Eigen::Vector3f>& normals);

/** \brief Turn normals of unknown sign so that neighbours agree, along the minimum spanning tree of the graph of
 * nearest neighbours, whose edges cost most where normals differ most (H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W.
 * Stuetzle, "Surface Reconstruction from Unorganized Points", SIGGRAPH 1992), also across creases; then each connected
 * piece outward. Neighbours come from pcl::search. O (points log points).
 * \param[in] points metres, finite
 * \param[in,out] normals one per point; those that are not finite stay as they are
 * \param[in] rightShare which share of a piece, points and normals, points to the right side: below 0.5 it is turned
 * \param[in] neighbours edges of the graph from each point
 * \throws InvalidArgument if there is not one normal per point */
PCL_COSECTION_EXPORT void orientConsistently (
    const std::vector<Eigen::Vector3f>& points, std::vector<Eigen::Vector3f>& normals,
    const std::function<double (const std::vector<Eigen::Vector3f>&, const std::vector<Eigen::Vector3f>&)>& rightShare =
        outwardShare,
    int neighbours = 12);

} // namespace pcl::cosection
