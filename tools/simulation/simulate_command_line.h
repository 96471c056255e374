// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include "pcl_cosection/simulation/table_scenes.h"

#include <optional>
#include <string>

/** \brief What the user of pcl_cosection_simulate asked for. */
struct SimulateSettings : GeneralOptions
{
  std::string spec;   ///< file; empty: a preset
  std::string preset; ///< empty: a file
  std::string output, print_preset, json;
  bool list_presets = false, no_noise = false;
  std::string frames; ///< as the user gives them: A:B
  int first_frame = 0;
  int last_frame = -1; ///< not rendered itself; -1: all
  std::optional<long> seed;
  std::optional<int> views_every;
  std::string meshes; ///< folder; empty: no scenes of meshes
  pcl::cosection::TableSceneOptions table;
};

/** \brief What pcl_cosection_simulate says about itself. */
const ProgramText& simulationText ();

void declareSimulationOptions (CLI::App& app, SimulateSettings& settings);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<SimulateSettings> parseSimulateCommandLine (int argc, const char* const* argv);
