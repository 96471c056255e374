// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_command_line.h"

#include "option_values.h"

#include "pcl_cosection/common/atomic_file.h"

#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace {

bool
isPage (const fs::path& path)
{
  return (path.extension () == ".html" || path.extension () == ".htm");
}

/** \brief Whether a path lies in a folder that is there. */
bool
isIn (const fs::path& path, const fs::path& folder)
{
  std::error_code failure;
  if (!fs::is_directory (folder, failure))
    return (false);
  const fs::path inner = fs::weakly_canonical (fs::absolute (path, failure), failure);
  const fs::path outer = fs::weakly_canonical (folder, failure);
  return (std::mismatch (outer.begin (), outer.end (), inner.begin (), inner.end ()).first == outer.end ());
}

/** \throws UsageError if the report would take the place of anything that is read, links included */
void
keepInputs (const ReportSettings& settings)
{
  const fs::path target = pcl::cosection::followLinks (settings.output);
  std::vector<std::string> runs = settings.others;
  runs.push_back (settings.run);
  for (const std::string& run : runs)
    for (const char* name : {"mesh", "trajectory", "keyframes"})
      if (isIn (target, fs::path (run) / name))
        throw UsageError (settings.output + " is where the run " + run + " has its files; give another name");
  runs.push_back (settings.truth);
  std::error_code failure;
  for (const std::string& input : runs)
    if (!input.empty () && fs::exists (target, failure) && !isPage (target) && isIn (target, input))
      throw UsageError (settings.output + " would be overwritten: it is part of the input " + input);
}

} // namespace

const ProgramText&
reportText ()
{
  static const ProgramText text = {
      "pcl_cosection_report",
      "show a run in one HTML file",
      "pcl_cosection_report [OPTIONS] OUTPUT",
      "Writes one HTML file that shows what a run of pcl_cosection_fusion did: tables, pictures before and after, "
      "trajectories, "
      "times, and the meshes to turn and to play. It needs no network and can be sent, printed and read on a phone.",
      {"OUTPUT is the folder that pcl_cosection_fusion wrote. It is only read.",
       "With --truth, DATASET is a folder with the truth as pcl_cosection_simulate writes it: accuracy, completeness "
       "and errors "
       "of trajectories come into the report. With --compare, other runs stand beside this one."},
      {
          {"pcl_cosection_report things", "report.html in the current folder"},
          {"pcl_cosection_report --truth table -o things.html things", "with the errors"},
          {"pcl_cosection_report --truth table --compare things_none things", "beside another run"},
      },
      {"truth = table", "output = things.html"},
  };
  return (text);
}

void
declareReportOptions (CLI::App& app, GivenReport& given)
{
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  const std::string input = "Input", output = "Output";
  app.add_option ("--truth", given.truth, "Compare with the truth of this dataset")
      ->option_text ("DATASET")
      ->group (input);
  app.add_option ("--compare", given.others, "Another run to set beside this one, with other options; repeatable")
      ->option_text ("OUTPUT2")
      ->allow_extra_args (false)
      ->group (input);
  app.add_option ("-o,--output", given.output, "The report (default: report.html)")
      ->option_text ("FILE.html")
      ->group (output);
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_report", given.verbose, given.quiet);
}

std::optional<ReportSettings>
parseReportCommandLine (int argc, const char* const* argv)
{
  GivenReport given;
  CLI::App app;
  declareReportOptions (app, given);
  if (!parseArguments (app, reportText (), argc, argv))
    return (std::nullopt);
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  if (given.paths.empty ())
    throw UsageError ("OUTPUT is missing, the folder that pcl_cosection_fusion wrote; see --help");
  if (given.paths.size () > 1)
    throw UsageError ("there is one argument too many: " + given.paths[1] + "; the report is named with -o");
  ReportSettings settings;
  settings.run = given.paths[0];
  settings.truth = given.truth;
  settings.others = given.others;
  if (settings.run.empty ())
    throw UsageError ("OUTPUT is empty; it must be the folder that pcl_cosection_fusion wrote");
  if (!given.output.empty ())
    settings.output = given.output;
  if (!isPage (settings.output))
    throw UsageError ("-o must end in .html; it is " + settings.output);
  settings.threads = given.threads.value_or (0);
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  keepInputs (settings);
  return (settings);
}
