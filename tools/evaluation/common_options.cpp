// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common_options.h"

#include "arguments.h"
#include "option_values.h"

void
declareCommonOptions (CLI::App& app, CommonOptions& given)
{
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  app.add_option ("--json", given.json, "Write all numbers for programs")->option_text ("FILE")->group ("Output");
  app.add_option ("--csv", given.csv, "Write the table, a row for each object")->option_text ("FILE")->group ("Output");
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_evaluate", given.verbose, given.quiet);
}

void
checkCommonOptions (const CommonOptions& given, const std::string& first, const std::string& second)
{
  if (given.paths.empty ())
    throw UsageError (first + " and " + second + " are missing; see --help");
  if (given.paths.size () == 1)
    throw UsageError (second + " is missing after " + given.paths[0] + "; see --help");
  if (given.paths.size () > 2)
    throw UsageError ("there is one argument too many: " + given.paths[2]);
  for (const std::string& path : given.paths)
    if (path.empty ())
      throw UsageError (first + " and " + second + " must not be empty");
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
}

Verbosity
verbosityOf (const CommonOptions& given)
{
  return (given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal);
}
