// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "body_energy.h"
#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <vector>

namespace pcl::cosection {

/** \brief What the error of a place on a completed surface depends on. Metres. */
struct ErrorSources
{
  double noise_m = 0.0;         ///< standard deviation of the sensor's readings there; 0: not known
  double voxel_size_m = 0.0;    ///< of the grid
  double data_distance_m = 0.0; ///< to the nearest measured point
  double size_m = 0.0;          ///< longest observed extent of the body
  bool has_target = false;      ///< a prior has a target there, for which there is evidence
};

/** \brief 95 % of the errors far from points are smaller than these shares of the longest observed extent. Fitted. */
struct SizeShares
{
  double with_target = 0.05; ///< where a prior has a target
  double without = 0.14;     ///< where smoothness and bounds decide
};

/** \brief TriangleMesh::sigma_m of a place, metres: two sigma hold the truth for 95 % of the vertices.
 *
 *     sigma^2 = noise^2 + (h / 4)^2 + (min (d, s L) / 2)^2
 *
 * with the voxel size h, the distance d to the nearest measured point, and the longest observed extent L. The truth
 * goes through the measured points, so no error is larger than d and the noise: two sigma are d near the points. Far
 * from them an error is at most a share s of the size of the body, which is smaller where a prior has evidence. The two
 * shares are fitted by the program fit_expected_error (test/benchmark/comparisons). */
double expectedError (const ErrorSources& sources, const SizeShares& shares = {});

/** \brief The sources of error of each vertex of a body's mesh.
 * \param[in] points the measurements of the body
 * \param[in] views of the body; without them the noise is not known
 * \param[in] size_m longest observed extent */
std::vector<ErrorSources> errorSources (const BodyEnergy& energy, const std::vector<OrientedPoint>& points,
                                        const SensorViews& views, double size_m, const TriangleMesh& mesh);

/** \brief Set TriangleMesh::sigma_m to the expectedError () of the sources. */
void attachExpectedErrors (const std::vector<ErrorSources>& sources, TriangleMesh& mesh);

} // namespace pcl::cosection
