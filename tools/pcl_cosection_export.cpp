// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Makes rigid bodies of completed objects; see pcl_cosection_export --help.

#include "export_command_line.h"
#include "export_report.h"
#include "run_program.h"

namespace {

bool
run (const ExportProgramSettings& settings, Terminal& terminal)
{
  catchInterruptions ();
  report (exportScene (settings.result, settings.output, settings, [] { return (!interrupted ()); }), settings.output,
          terminal);
  return (true);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_export", "interrupted, nothing was written"}, argc, argv, parseExportCommandLine,
                      run));
}
