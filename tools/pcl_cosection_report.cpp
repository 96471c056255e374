// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Shows a run of pcl_cosection_fusion in one HTML file; see pcl_cosection_report --help.

#include "output_files.h"
#include "report_command_line.h"
#include "report_page.h"
#include "run_program.h"

#include <pcl/cosection/common/error.h>

#include <cstdio>

using namespace pcl::cosection;

namespace {

/** \brief Compare with the truth, if there is any; a run that cannot be compared is reported all the same. */
void
addTruth (ReportContent& content, Terminal& terminal)
{
  if (content.truth_folder.empty ())
    return;
  terminal.progress ("comparing with the truth", 0.1);
  try
  {
    content.truth = compareWithTruth (content.scene, content.truth_folder, content.threads);
    measureErrors (content.scene, content.truth->truth, content.truth->evaluation, content.threads);
    content.warnings.insert (content.warnings.end (), content.truth->notes.begin (), content.truth->notes.end ());
  }
  catch (const IoError&) // there is no truth
  {
    throw;
  }
  catch (const Error& error)
  {
    content.warnings.push_back ("the run cannot be compared with the truth of " + content.truth_folder + ": " +
                                error.what ());
  }
}

void
addOtherRuns (ReportContent& content, const std::vector<std::string>& folders, Terminal& terminal)
{
  for (const std::string& folder : folders)
  {
    terminal.progress ("comparing with " + folder, 0.3);
    ComparedRun other{lastPartOf (folder), readRunFolder (folder), std::nullopt};
    for (const std::string& note : other.run.notes)
      content.warnings.push_back (folder + ": " + note);
    try
    {
      if (content.truth)
        other.evaluation = compareWithTruth (sceneOf (other.run), content.truth_folder, content.threads).evaluation;
    }
    catch (const Error& error)
    {
      content.warnings.push_back (folder + " cannot be compared with the truth: " + error.what ());
    }
    content.others.push_back (std::move (other));
  }
}

bool
run (const ReportSettings& settings, Terminal& terminal)
{
  catchInterruptions ();
  terminal.progress ("reading", 0.0);
  ReportContent content;
  content.threads = settings.threads;
  content.truth_folder = settings.truth;
  content.run = readRunFolder (settings.run);
  content.scene = sceneOf (content.run);
  requireWritable (settings.output);
  content.warnings = content.run.notes;
  if (!content.run.failure.empty ())
    terminal.warning ("the run failed: " + content.run.failure);
  addTruth (content, terminal);
  addOtherRuns (content, settings.others, terminal);
  for (const std::string& warning : content.warnings)
    terminal.warning (warning);
  const std::string page = reportPage (content, [&] (const std::string& stage, double fraction) {
    terminal.progress (stage, 0.5 + 0.5 * fraction);
    return (!interrupted ());
  });
  saveText (page, settings.output);
  char size[32];
  std::snprintf (size, sizeof (size), "%.1f MB", static_cast<double> (page.size ()) / 1e6);
  terminal.result ("wrote " + settings.output + ": " + counted (content.run.objects.size (), "object") + ", " + size);
  return (true);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_report", "interrupted; nothing was written"}, argc, argv, parseReportCommandLine,
                      run));
}
