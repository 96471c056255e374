// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "help_text.h"

#include <CLI/CLI.hpp>

#include <stdexcept>

/** \brief The command line, or the configuration file, is not right; what () is one line. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** \brief Add what all programs have, in the group "General": --verbose, --quiet, --config, --version and --help. */
void declareGeneralOptions (CLI::App& app, const std::string& program, bool& verbose, bool& quiet);

/** \brief Read the command line, and the configuration file that it names. Prints what --help and --version ask for.
 * \return whether there is anything left to do
 * \throws UsageError */
bool parseArguments (CLI::App& app, const ProgramText& program, int argc, const char* const* argv);
