// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"
#include "export_scene.h"

#include <optional>
#include <string>
#include <vector>

/** \brief What pcl_cosection_export says about itself. */
const ProgramText& exportText ();

/** \brief What the user asked for. */
struct ExportProgramSettings : GeneralOptions, ExportSettings
{
  std::vector<std::string> mass_values; ///< "ID=KG"
  std::string collision = "parts", frame = "auto";
  std::string result; ///< folder
  std::string output; ///< folder
};

/** \brief Declare every option of the program, and where the help screen shows it. */
void declareExportOptions (CLI::App& app, ExportProgramSettings& settings);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<ExportProgramSettings> parseExportCommandLine (int argc, const char* const* argv);
