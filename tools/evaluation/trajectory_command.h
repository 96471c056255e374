// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_commands.h"

#include <pcl/cosection/evaluation/trajectory_error.h>

#include <optional>
#include <string>

/** \brief How trajectories are compared, as the user gave it. */
struct TrajectorySettings
{
  std::optional<double> max_difference_s;
  std::string align = "se3";
  int delta = 1;

  pcl::cosection::TrajectoryOptions options () const;
};

/** \brief Declare --max-difference, --align and --delta. */
void declareTrajectoryOptions (CLI::App& app, TrajectorySettings& settings);

/** \brief pcl_cosection_evaluate trajectory. */
EvaluationCommand trajectoryCommand ();
