// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terminal.h"

#include <exception>
#include <functional>
#include <optional>
#include <string>

/** \brief What is to be said of an error. \param[in] out_of_memory of that one, which says nothing itself */
std::string describe (const std::exception& error, const std::string& out_of_memory = "out of memory");

/** \brief A program, and what it says when it ends early. */
struct Program
{
  std::string name;
  std::string interrupted = "interrupted";
  std::string out_of_memory = "out of memory"; ///< may say what would need less
};

/** \brief The main function of all programs: what \a work throws becomes one line and an exit status, and so does a
 * standard output that cannot be written. A file larger than the system's limit and a closed pipe are errors of
 * writing.
 * \param[in] work returns whether all went well; reads the command line first
 * \return 0: all went well, 1: it did not, also if anything else is thrown, 2 after a UsageError, 130 after
 * pcl::cosection::Cancelled */
int runProgram (const Program& program, const std::function<bool (Terminal&)>& work);

/** \brief The main function of a program. \param[in] read the command line; nothing: there is nothing left to do
 * \param[in] work returns whether all went well */
template <typename Settings>
int
runProgram (const Program& program, int argc, const char* const* argv,
            std::optional<Settings> (*read) (int argc, const char* const* argv),
            bool (*work) (const Settings& settings, Terminal& terminal))
{
  return (runProgram (program, [&] (Terminal& terminal) {
    const std::optional<Settings> settings = read (argc, argv);
    if (!settings)
      return (true);
    terminal.setVerbosity (settings->verbosity);
    return (work (*settings, terminal));
  }));
}

/** \brief From now on, the first SIGINT, SIGTERM or SIGHUP only sets a flag; a second one ends the program at once. */
void catchInterruptions ();

/** \brief Whether a signal has asked the program to stop. */
bool interrupted ();
