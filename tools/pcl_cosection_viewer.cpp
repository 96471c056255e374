// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Shows what pcl_cosection_fusion wrote, in a window or as pictures; see pcl_cosection_viewer --help.

#include "interruption.h"
#include "run_program.h"
#include "terminal.h"
#include "viewer_command_line.h"
#include "viewer_pictures.h"
#include "viewer_window.h"

namespace {

void
run (const ViewerSettings& settings, Terminal& terminal)
{
  if (settings.needsWindow ())
    return (showWindow (settings, terminal));
  checkPictures (settings);
  writePictures (settings, loadScene (settings, terminal), terminal);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_viewer", "interrupted; what was written is whole"}, [&] (Terminal& terminal) {
    const std::optional<ViewerSettings> settings = parseViewerCommandLine (argc, argv);
    if (!settings)
      return (true);
    terminal.setVerbosity (settings->verbosity);
    catchInterruptions ();
    run (*settings, terminal);
    return (true);
  }));
}
