// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// make_man_page PROGRAM: prints the manual page of a program, which says what --help says. Part of the build, not
// installed.

#include "command_line.h"
#include "evaluation_commands.h"
#include "export_command_line.h"
#include "fusion_command_line.h"
#include "report_command_line.h"
#include "segment_command_line.h"
#include "simulate_command_line.h"
#include "viewer_command_line.h"

#include <iostream>

namespace {

template <typename Given>
void
print (const ProgramText& program, void (*declare) (CLI::App&, Given&))
{
  CLI::App app;
  Given given;
  declare (app, given);
  std::cout << manPage (app, program);
}

} // namespace

int
main (int argc, char** argv)
{
  const std::string program = argc == 2 ? argv[1] : "";
  if (program == "pcl_cosection")
    print (completionText (), declareOptions);
  else if (program == "pcl_cosection_evaluate")
    std::cout << evaluationManPage ();
  else if (program == "pcl_cosection_export")
    print (exportText (), declareExportOptions);
  else if (program == "pcl_cosection_fusion")
    print (fusionText (), declareFusionOptions);
  else if (program == "pcl_cosection_report")
    print (reportText (), declareReportOptions);
  else if (program == "pcl_cosection_segment")
    print (segmentationText (), declareSegmentationOptions);
  else if (program == "pcl_cosection_simulate")
    print (simulationText (), declareSimulationOptions);
  else if (program == "pcl_cosection_viewer")
    print (viewerText (), declareViewerOptions);
  else
    return (2);
  return (std::cout.flush () ? 0 : 1);
}
