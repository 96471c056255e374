// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"
#include "terminal.h"

#include <optional>
#include <string>

/** \brief What the user of pcl_cosection_simulate asked for. */
struct SimulateSettings
{
  std::string spec;   ///< file; empty: a preset
  std::string preset; ///< empty: a file
  std::string output;
  bool list_presets = false;
  std::string print_preset;
  int first_frame = 0;
  int last_frame = -1; ///< not rendered itself; -1: all
  std::optional<long> seed;
  std::optional<int> views_every;
  bool no_noise = false;
  std::string json;
  int threads = 0;
  Verbosity verbosity = Verbosity::Normal;
};

/** \brief What pcl_cosection_simulate says about itself. */
const ProgramText& simulationText ();

/** \brief Options as the user gives them. */
struct GivenSimulation
{
  std::vector<std::string> paths;
  std::string preset, print_preset, frames, json;
  std::optional<long> seed;
  std::optional<int> views_every, threads;
  bool list_presets = false, no_noise = false, verbose = false, quiet = false;
};

void declareSimulationOptions (CLI::App& app, GivenSimulation& given);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<SimulateSettings> parseSimulateCommandLine (int argc, const char* const* argv);
