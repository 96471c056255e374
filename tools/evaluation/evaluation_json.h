// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/trajectory_error.h>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

using Json = nlohmann::ordered_json;

constexpr double degrees_per_rad = 180.0 / M_PI;

/** \brief [tx, ty, tz, qx, qy, qz, qw] */
Json toJson (const Eigen::Isometry3d& pose);

/** \brief Vertices, triangles, topology, area and volume. */
Json toJson (const pcl::cosection::MeshSummary& summary);

/** \brief Set accuracy_m and so on of \a json. */
void addComparison (const pcl::cosection::MeshComparison& comparison, double f_threshold_m, Json& json);

/** \brief Set ate_rmse_m and so on of \a json. */
void addTrajectoryError (const pcl::cosection::TrajectoryError& error, Json& json);

/** \brief "closed, Euler characteristic 2, 1 part" or what is wrong. */
std::string describeTopology (const pcl::cosection::MeshTopology& topology);
