// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief \throws InvalidArgument if a triangle refers to a vertex that does not exist, or to one that is not finite.
 * \throws DegenerateInput if the mesh has no triangles, or none of any area
 * \param[in] name what the message calls the mesh */
void requireSurface (const TriangleMesh& mesh, const char* name = "mesh");

/** \brief The area of a mesh, square metres. */
double surfaceArea (const TriangleMesh& mesh);

/** \brief Points on a mesh, uniform by area and independent of each other: the same for the same \a seed everywhere.
 *
 * Triangles by their share of the area, points in them by R. Osada et al., "Shape Distributions", TOG 2002.
 * \return \a count points, metres, in the frame of the mesh
 * \throws InvalidArgument, DegenerateInput as requireSurface () */
std::vector<Eigen::Vector3d> sampleSurface (const TriangleMesh& mesh, std::size_t count, std::uint64_t seed = 0);

} // namespace pcl::cosection
