// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terminal.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/trajectory_error.h>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

using Json = nlohmann::ordered_json;

constexpr double degrees_per_rad = 180.0 / M_PI;

/** \brief The value; null if it is not known. */
template <typename Value>
Json
orNull (const std::optional<Value>& value)
{
  return (value ? Json (*value) : Json ());
}

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

/** \brief A table in columns: the first one flush left, the others flush right. */
class TextTable
{
public:
  explicit TextTable (std::vector<std::string> header) { add (std::move (header)); }

  void add (std::vector<std::string> row) { rows_.push_back (std::move (row)); }

  void print (Terminal& terminal) const;

private:
  std::vector<std::vector<std::string>> rows_;
};

/** \brief Metres as millimetres, with three digits: "4.12". */
std::string inMillimetres (double metres);

/** \brief Cubic metres as millilitres. */
std::string inMillilitres (double cubic_metres);

/** \brief "12.3 %" */
std::string inPercent (double share);

/** \brief With \a digits significant digits. */
std::string toText (double value, int digits = 3);

/** \brief A stamp or a parameter, without zeros at its end: "0.01", "99", "1305031102.175". */
std::string toShortText (double value);

/** \brief For CSV files: as many digits as a number has; empty if it is not known. */
std::string toField (const std::optional<double>& value);
