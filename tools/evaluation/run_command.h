// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common_options.h"
#include "trajectory_command.h"

#include <CLI/CLI.hpp>

#include <string>

/** \brief What the user asked of the command run. */
struct RunSettings
{
  TrajectorySettings trajectory; ///< with the common options
  long samples = 10000;
  std::uint64_t seed = 0;
  double f_threshold_m = 0.01;
  std::string refine = "observed"; ///< or none
  double penetration_voxel_m = 0.0;
};

void declareRunOptions (CLI::App& app, RunSettings& settings);

/** \brief pcl_cosection_evaluate run. \throws UsageError, pcl::cosection::Error */
void runRunCommand (int argc, const char* const* argv, Terminal& terminal);
