// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_command_line.h"

#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/common/files.h"

#include <filesystem>

namespace fs = std::filesystem;

namespace {

bool
isPage (const fs::path& path)
{
  return (path.extension () == ".html" || path.extension () == ".htm");
}

/** \throws UsageError if the report would take the place of anything that is read, links included */
void
keepInputs (const ReportSettings& settings)
{
  refuseToOverwrite ({configurationFile (settings.arguments)}, {settings.output});
  std::error_code failure;
  const fs::path target = pcl::cosection::followLinks (settings.output);
  const auto isIn = [&, path = fs::absolute (target, failure).string ()] (const fs::path& folder) {
    return (fs::is_directory (folder, failure) && isWithin (path, folder.string ()));
  };
  std::vector<std::string> runs = settings.others;
  runs.push_back (settings.run);
  for (const std::string& run : runs)
    for (const char* name : {"mesh", "trajectory", "keyframes"})
      if (isIn (fs::path (run) / name))
        throw UsageError (settings.output + " is where the run " + run + " has its files; give another name");
  runs.push_back (settings.truth);
  for (const std::string& input : runs)
    if (!input.empty () && fs::exists (target, failure) && !isPage (target) && isIn (input))
      throw UsageError (settings.output + " would be overwritten: it is part of the input " + input);
}

void
interpret (ReportSettings& settings)
{
  if (settings.paths.empty ())
    throw UsageError ("OUTPUT is missing, the folder that pcl_cosection_fusion or pcl_cosection wrote; see --help");
  if (settings.paths.size () > 1)
    throw UsageError ("there is one argument too many: " + settings.paths[1] + "; the report is named with -o");
  settings.run = settings.paths[0];
  if (settings.run.empty ())
    throw UsageError ("OUTPUT is empty; it must be the folder that pcl_cosection_fusion or pcl_cosection wrote");
  if (settings.output.empty ())
    settings.output = "report.html";
  if (!isPage (settings.output))
    throw UsageError ("-o must end in .html; it is " + settings.output);
  keepInputs (settings);
}

} // namespace

const ProgramText&
reportText ()
{
  static const ProgramText text = {
      "pcl_cosection_report",
      "show a run or completed views in one HTML file",
      "pcl_cosection_report [OPTIONS] OUTPUT",
      "Writes one HTML file that shows what pcl_cosection_fusion made of a sequence, or pcl_cosection of views: "
      "tables, "
      "pictures before and after, trajectories, times, and the meshes to turn and to play. It needs no network and can "
      "be sent, printed and read on a phone.",
      {"OUTPUT is the folder that pcl_cosection_fusion or pcl_cosection wrote. It is only read.",
       "With --truth, DATASET is a folder with the truth as pcl_cosection_simulate writes it: accuracy, completeness "
       "and errors of trajectories come into the report. With --compare, other runs stand beside this one."},
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
declareReportOptions (CLI::App& app, ReportSettings& settings)
{
  OptionGroup input (app, "Input");
  input.add ("--truth DATASET", settings.truth, "Compare with the truth of this dataset");
  input.add ("--compare OUTPUT2", settings.others,
             "Another run to set beside this one, with other options; repeatable");
  OptionGroup (app, "Output").add ("-o,--output FILE.html", settings.output, "The report (default: report.html)");
  declareGeneralOptions (app, "pcl_cosection_report", settings);
}

std::optional<ReportSettings>
parseReportCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<ReportSettings> (argc, argv, reportText (), declareReportOptions, interpret));
}
