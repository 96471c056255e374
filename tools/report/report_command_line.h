// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include <optional>
#include <string>
#include <vector>

/** \brief What the user of pcl_cosection_report asked for. */
struct ReportSettings : GeneralOptions
{
  std::string run;                 ///< folder
  std::string truth;               ///< dataset; empty: not given
  std::vector<std::string> others; ///< folders of other runs
  std::string output;
};

/** \brief What pcl_cosection_report says about itself. */
const ProgramText& reportText ();

void declareReportOptions (CLI::App& app, ReportSettings& settings);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError, also where
 * the report would be written over an input */
std::optional<ReportSettings> parseReportCommandLine (int argc, const char* const* argv);
