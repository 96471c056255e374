// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// Shows what pcl_cosection_fusion wrote, in a window or as pictures; see pcl_cosection_viewer --help.

#include "exit_status.h"
#include "interruption.h"
#include "terminal.h"
#include "viewer_command_line.h"
#include "viewer_pictures.h"
#include "viewer_window.h"

#include <pcl/cosection/common/error.h>

#include <new>

using namespace pcl::cosection;

namespace
{

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
  Terminal terminal ("pcl_cosection_viewer");
  try
  {
    const std::optional<ViewerSettings> settings = parseViewerCommandLine (argc, argv);
    if (!settings)
      return (Success);
    terminal.setVerbosity (settings->verbosity);
    catchInterruptions ();
    run (*settings, terminal);
    return (Success);
  }
  catch (const UsageError& error)
  {
    terminal.error (error.what ());
    return (WrongUsage);
  }
  catch (const Cancelled&)
  {
    terminal.error ("interrupted; what was written is whole");
    return (Interrupted);
  }
  catch (const std::bad_alloc&)
  {
    terminal.error ("out of memory");
  }
  catch (const std::exception& error)
  {
    terminal.error (error.what ());
  }
  return (Failure);
}
