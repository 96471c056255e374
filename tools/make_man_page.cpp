// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// make_man_page PROGRAM: prints the manual page of a program, which says what --help says. Part of the build, not
// installed.

#include "evaluation_commands.h"
#include "fusion_command_line.h"
#include "option_table.h"
#include "program_text.h"
#include "report_command_line.h"
#include "segment_command_line.h"
#include "simulate_command_line.h"
#include "viewer_command_line.h"

#include <iostream>

int
main (int argc, char** argv)
{
  const std::string program = argc == 2 ? argv[1] : "";
  if (program == "pcl_cosection")
  {
    CLI::App app;
    Given given;
    declareOptions (app, given);
    std::cout << manPage (app, completionText ()) << std::flush;
  }
  else if (program == "pcl_cosection_evaluate")
    std::cout << evaluationManPage () << std::flush;
  else if (program == "pcl_cosection_fusion")
  {
    CLI::App app;
    GivenFusion given;
    declareFusionOptions (app, given);
    std::cout << manPage (app, fusionText ()) << std::flush;
  }
  else if (program == "pcl_cosection_report")
  {
    CLI::App app;
    GivenReport given;
    declareReportOptions (app, given);
    std::cout << manPage (app, reportText ()) << std::flush;
  }
  else if (program == "pcl_cosection_segment")
  {
    CLI::App app;
    GivenSegmentation given;
    declareSegmentationOptions (app, given);
    std::cout << manPage (app, segmentationText ()) << std::flush;
  }
  else if (program == "pcl_cosection_simulate")
  {
    CLI::App app;
    GivenSimulation given;
    declareSimulationOptions (app, given);
    std::cout << manPage (app, simulationText ()) << std::flush;
  }
  else if (program == "pcl_cosection_viewer")
  {
    CLI::App app;
    GivenViewer given;
    declareViewerOptions (app, given);
    std::cout << manPage (app, viewerText ()) << std::flush;
  }
  else
    return (2);
  return (std::cout ? 0 : 1);
}
