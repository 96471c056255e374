// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstddef>

namespace pcl::cosection {

/** \brief The largest number of points for sampleEvenly (). */
constexpr std::size_t most_even_samples = 10000000;

/** \brief The distance between neighbours, metres, in a hexagonal lattice of \a count points on a flat area: sqrt (2
 * area / (sqrt (3) count)). */
double hexagonalSpacing (double area_m2, std::size_t count);

/** \brief Points evenly spread over a mesh: none is close to another one, and no place is far from all.
 *
 * Five times as many candidates are drawn, uniform by area, of which the one with most others near it is eliminated
 * until \a count are left (C. Yuksel, "Sample Elimination for Generating Poisson Disk Sample Sets", Eurographics 2015,
 * with its weights, alpha = 8, and its weight limiting, beta = 0.65 and gamma = 1.5). Candidates whose normals are more
 * than 120 degrees apart are not near: each side of a thin wall is covered by itself. Along a smooth surface the
 * nearest two points are some 0.7 times hexagonalSpacing () apart.
 *
 * The same mesh and count give the same points everywhere, for any number of threads.
 * O (count log count), about 600 bytes of memory for each point.
 *
 * \param[in] mesh any that has an area: open, of many parts, with degenerate triangles
 * \param[in] count from 1 to most_even_samples
 * \param[in] threads 0: all
 * \return a mesh without triangles whose vertices are the points (metres, in the frame of \a mesh, in random order),
 * with what the vertices of \a mesh have: interpolated, but provenance, which is that of the nearest corner of the
 * triangle. There are always normals; they are the triangles' where \a mesh has none, or such that point backwards
 * \throws InvalidArgument if \a count is out of range, or the mesh is not consistent or not finite
 * \throws DegenerateInput if the mesh has no triangles, or none of any area */
TriangleMesh sampleEvenly (const TriangleMesh& mesh, std::size_t count, int threads = 0);

} // namespace pcl::cosection
