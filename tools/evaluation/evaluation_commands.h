// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terminal.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

struct ProgramText;

/** \brief A command of pcl_cosection_evaluate. */
struct EvaluationCommand
{
  std::string word;
  const ProgramText* text;
  std::function<void (CLI::App& app)> declare; ///< its options, for help only: their values go nowhere
  /** \brief \throws UsageError, pcl::cosection::Error */
  std::function<void (int argc, const char* const* argv, Terminal& terminal)> run;
};

const std::vector<EvaluationCommand>& evaluationCommands ();

/** \brief What --help shows; see helpText (). */
std::string evaluationHelp ();

/** \brief The manual page of all commands. */
std::string evaluationManPage ();
