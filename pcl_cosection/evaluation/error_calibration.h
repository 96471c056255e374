// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

class SurfaceDistance;

/** \brief The error of a vertex beside the one that was expected. */
struct VertexError
{
  double error_m = 0.0; ///< distance to the true surface
  double sigma_m = 0.0; ///< TriangleMesh::sigma_m
  std::uint8_t provenance = 0;
};

/** \brief The errors of all vertices; empty if the mesh has no sigma_m or no provenance. \param[in] threads 0: all */
std::vector<VertexError> vertexErrors (const SurfaceDistance& truth, const TriangleMesh& mesh, int threads = 0);

/** \brief How well expected errors describe true ones; of no vertices, all are 0. */
struct ErrorCoverage
{
  std::size_t vertices = 0;
  double within_sigma = 0.0;     ///< share of the vertices whose error is at most sigma
  double within_two_sigma = 0.0; ///< ... at most two sigma; 0.95 is right
  double mean_sigma_m = 0.0;     ///< arithmetic mean
  double mean_error_m = 0.0;     ///< arithmetic mean
  double p95_error_m = 0.0;      ///< 95 % of the errors are at most this large
};

ErrorCoverage errorCoverage (const std::vector<VertexError>& errors);

/** \brief The coverage of the vertices with one provenance. */
ErrorCoverage errorCoverage (const std::vector<VertexError>& errors, Provenance provenance);

/** \brief The calibration curve: the coverage in classes of about as many vertices each, by ascending sigma.
 *
 * If sigma is right, p95_error_m is twice mean_sigma_m in each class. If it were one constant, the classes would differ
 * in their errors alone. */
std::vector<ErrorCoverage> calibrationCurve (std::vector<VertexError> errors, std::size_t classes);

/** \brief Spearman's rank correlation of error and sigma: 1 if the larger sigma always has the larger error; 0 for
 * fewer than two vertices. */
double rankCorrelation (const std::vector<VertexError>& errors);

/** \brief Share of points, uniform by area on \a surface, that lie inside \a bound or no farther than \a tolerance_m
 * outside of it.
 * \param[in] bound closed
 * \param[in] samples number of points
 * \throws InvalidArgument if \a bound is not closed */
double shareInside (const TriangleMesh& surface, const TriangleMesh& bound, double tolerance_m, std::size_t samples,
                    std::uint64_t seed);

} // namespace pcl::cosection
