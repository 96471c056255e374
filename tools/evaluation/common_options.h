// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terminal.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/** \brief The options that all commands have. */
struct CommonOptions
{
  std::vector<std::string> paths;
  std::string json, csv;
  std::optional<int> threads;
  bool verbose = false, quiet = false;
};

/** \brief Declare --json and --csv in the group "Output", and the general ones. */
void declareCommonOptions (CLI::App& app, CommonOptions& given);

/** \brief \throws UsageError unless there are two paths, which are not empty, and the verbosity is clear
 * \param[in] first, second what the paths are */
void checkCommonOptions (const CommonOptions& given, const std::string& first, const std::string& second);

Verbosity verbosityOf (const CommonOptions& given);
