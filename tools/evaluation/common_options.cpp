// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common_options.h"

#include "option_values.h"
#include "output_files.h"
#include "run_program.h"

#include <nlohmann/json.hpp>

#include <pcl/cosection/common/error.h>

void
declareCommonOptions (CLI::App& app, CommonOptions& given)
{
  OptionGroup output (app, "Output");
  output.add ("--json FILE", given.json, "Write all numbers for programs");
  output.add ("--csv FILE", given.csv, "Write the table, a row for each object");
  declareGeneralOptions (app, "pcl_cosection_evaluate", given);
}

pcl::cosection::MeshComparisonOptions
SurfaceOptions::comparison (int threads) const
{
  pcl::cosection::MeshComparisonOptions options;
  options.samples = static_cast<std::size_t> (samples);
  options.seed = seed;
  options.f_threshold_m = f_threshold_m;
  options.threads = threads;
  return (options);
}

void
declareSurfaceOptions (OptionGroup& group, SurfaceOptions& given)
{
  group.add ("--samples N", given.samples, wholeRange (1, 100000000),
             "Points on each mesh" + byDefault (given.samples));
  group.add ("--seed N", given.seed, wholeRange (0, std::numeric_limits<long>::max ()),
             "Of the points: the same seed, the same points" + byDefault (0));
  group.add ("--f-threshold METRES", given.f_threshold_m, positiveNumber (),
             "Distance up to which a point counts for precision, recall and F-score" + byDefault (given.f_threshold_m));
}

void
executeCommand (const CommonOptions& given, const std::string& first, const std::string& second,
                const std::function<void ()>& check, const std::function<bool ()>& work, Terminal& terminal)
{
  if (second.empty ())
    requirePath (given.paths, first);
  else
    requirePaths (given.paths, first, second);
  for (const std::string& path : given.paths)
    if (path.empty ())
      throw UsageError (first + (second.empty () ? "" : " and " + second) + " must not be empty");
  terminal.setVerbosity (verbosityOf (given));
  std::vector<std::string> inputs = given.paths;
  inputs.push_back (configurationFile (given.arguments));
  refuseToOverwrite (inputs, {given.json, given.csv});
  check ();
  bool whole = true;
  try
  {
    whole = work ();
  }
  catch (const std::exception& error)
  {
    if (!given.json.empty ())
      try
      {
        saveJson (nlohmann::ordered_json{{"error", describe (error)}}, given.json);
      }
      catch (const std::exception&)
      {
        // the error itself is reported
      }
    throw;
  }
  if (!whole)
    throw pcl::cosection::IoError ("a file could not be read, see the warnings; the rest was evaluated");
}
