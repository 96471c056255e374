// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "help_text.h"
#include "terminal.h"

#include <pcl/cosection/common/error.h>

#include <CLI/CLI.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/** \brief The command line, or the configuration file, is not right; what () is one line. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** \brief What all programs are given. */
struct GeneralOptions
{
  std::vector<std::string> arguments; ///< all, as the command line has them
  std::vector<std::string> paths;     ///< those that are no options
  int threads = 0;                    ///< 0: all processors
  bool verbose = false, quiet = false;
  Verbosity verbosity = Verbosity::Normal; ///< as these two say
};

/** \brief Declare the paths, and in the group "General" --threads, --verbose, --quiet, --config, --version and --help.
 */
void declareGeneralOptions (CLI::App& app, const std::string& program, GeneralOptions& given);

/** \brief The file that --config names in a command line, which is an input like any other; empty if there is none. */
std::string configurationFile (const std::vector<std::string>& arguments);

/** \brief \throws UsageError if the program is to be quiet and verbose */
Verbosity verbosityOf (const GeneralOptions& given);

/** \brief \throws UsageError unless there is one path \param[in] name what it is */
void requirePath (const std::vector<std::string>& paths, const std::string& name);

/** \brief \throws UsageError unless there are two paths, or more if there may be more of the first
 * \param[in] first, last what they are */
void requirePaths (const std::vector<std::string>& paths, const std::string& first, const std::string& last,
                   bool may_be_more = false);

/** \brief Read the command line, and the configuration file that it names. Prints what --help and --version ask for.
 * \return whether there is anything left to do
 * \throws UsageError */
bool parseArguments (CLI::App& app, const ProgramText& program, int argc, const char* const* argv);

/** \brief Read a command line into settings, which are derived from the options as the user gives them.
 * \param[in] interpret checks these and sets the rest
 * \return nothing if all that was asked for was printed (--help, --version) \throws UsageError */
template <typename Settings, typename Given>
std::optional<Settings>
readCommandLine (int argc, const char* const* argv, const ProgramText& program, void (*declare) (CLI::App&, Given&),
                 void (*interpret) (Settings&))
{
  Settings settings;
  CLI::App app;
  declare (app, settings);
  settings.arguments.assign (argv + 1, argv + argc);
  if (!parseArguments (app, program, argc, argv))
    return (std::nullopt);
  try
  {
    settings.verbosity = verbosityOf (settings);
    interpret (settings);
    return (settings);
  }
  catch (const pcl::cosection::InvalidArgument& error)
  {
    throw UsageError (error.what ());
  }
}

/** \brief The one of \a names with the smallest edit distance to \a word; the first if several
 * are as near, nothing if none is near. */
std::string nearestName (const std::string& word, const std::vector<std::string>& names);

/** \brief "; did you mean NAME?" of the nearest name, without dashes if \a bare; nothing if none is near. */
std::string suggestion (const std::string& word, const std::vector<std::string>& names, bool bare = false);
