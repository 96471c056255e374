// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common_options.h"

#include <pcl/cosection/evaluation/trajectory_error.h>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

/** \brief How trajectories are compared, as the user gave it. */
struct TrajectorySettings
{
  CommonOptions common;
  std::optional<double> max_difference_s;
  std::string align = "se3";
  int delta = 1;
};

/** \brief Declare --max-difference, --align and --delta. */
void declareComparisonOptions (CLI::App& app, TrajectorySettings& settings);

void declareTrajectoryOptions (CLI::App& app, TrajectorySettings& settings);

pcl::cosection::TrajectoryOptions trajectoryOptions (const TrajectorySettings& settings);

/** \brief pcl_cosection_evaluate trajectory. \throws UsageError, pcl::cosection::Error */
void runTrajectoryCommand (int argc, const char* const* argv, Terminal& terminal);
