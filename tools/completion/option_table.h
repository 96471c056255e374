// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "method_options.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

/** \brief The options as the user gave them: what is absent leaves the preset as it is. */
struct Given : GivenMethod
{
  std::vector<std::string> paths;
  std::optional<double> scale;
  std::optional<long> max_faces;
  std::string format, json;
  std::vector<std::string> planes, viewpoints, intrinsics, free_space, obstacles, object_trajectories;
  bool save_sdf = false, save_hull = false, save_bounds = false, world_points = false, verbose = false, quiet = false;
};

/** \brief Declare every option of the program, and where the help screen shows it. */
void declareOptions (CLI::App& app, Given& given);
