// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Shows what pcl_cosection_fusion wrote, in a window or as pictures; see pcl_cosection_viewer --help.

#include "output_files.h"
#include "run_program.h"
#include "viewer_command_line.h"
#include "viewer_pictures.h"

#include <pcl/cosection/common/error.h>

#ifdef PCL_COSECTION_HAS_WINDOW
#include <pcl/cosection/visualization/run_window.h>

#include <poll.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>
#endif

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

#ifdef PCL_COSECTION_HAS_WINDOW

/** \brief What is shown until there is a frame. */
RunScene
emptyScene ()
{
  RunScene scene;
  scene.run.camera.push_back ({});
  return (scene);
}

/** \brief Snapshots of a run that goes on. */
class FollowedRun
{
public:
  FollowedRun (const ViewerSettings& settings, Terminal& terminal) : settings_ (settings), terminal_ (terminal) {}

  FollowedRun (const FollowedRun&) = delete;
  FollowedRun& operator= (const FollowedRun&) = delete;

  /** \brief The latest snapshot, or the result; nothing if it is not new. */
  std::optional<SceneUpdate> next ()
  {
    if (ended_)
      return (std::nullopt);
    ended_ = inputEnded ();
    try
    {
      if (ended_)
        return (SceneUpdate{loadScene (settings_, terminal_), SurfaceMode::Completed});
      std::error_code failure;
      const auto time = fs::last_write_time (fs::path (settings_.follow) / "trajectory" / "camera.txt", failure);
      if (failure || time == time_)
        return (std::nullopt);
      time_ = time;
      ReadingNotes ignored;
      return (SceneUpdate{loadRunScene (settings_.follow, ignored), std::nullopt});
    }
    catch (const Error& error) // a snapshot that is being written; or the run has failed, and what was seen last stays
    {
      if (ended_)
        terminal_.error (error.what ());
      return (std::nullopt);
    }
  }

private:
  static bool inputEnded ()
  {
    pollfd input = {STDIN_FILENO, POLLIN, 0};
    if (poll (&input, 1, 0) <= 0)
      return (false);
    std::array<char, 64> bytes;
    return (read (STDIN_FILENO, bytes.data (), bytes.size ()) <= 0);
  }

  const ViewerSettings settings_;
  Terminal& terminal_;
  fs::file_time_type time_;
  bool ended_ = false;
};

RunWindowOptions
windowOptions (const ViewerSettings& settings, Terminal& terminal)
{
  RunWindowOptions options;
  options.title = "pcl_cosection_viewer: " + settings.run;
  options.view = settings.view;
  options.dataset = settings.dataset;
  options.threads = settings.threads;
  if (!settings.viewpoint.empty ())
    options.viewpoint_file = settings.viewpoint;
  if (isWithin (options.viewpoint_file, settings.run) || isWithin (".", settings.run))
    options.viewpoint_file.clear ();
  if (isWithin (".", settings.run))
    options.picture_prefix.clear ();
  options.stop = interrupted;
  options.said = [&terminal] (const std::string& line) {
    if (line.rfind ("wrote ", 0) == 0)
      terminal.result (line);
    else
      terminal.detail (line);
  };
  return (options);
}

void
showWindow (const ViewerSettings& settings, Terminal& terminal)
{
  std::shared_ptr<void> display; // kept while the run is loaded
  try
  {
    display = requireDisplay ();
  }
  catch (const IoError& error)
  {
    throw IoError (std::string (error.what ()) + "; --screenshot FILE.png and --record DIR draw without one");
  }
  RunWindowOptions options = windowOptions (settings, terminal);
  if (settings.follow.empty ())
  {
    RunScene scene = loadScene (settings, terminal);
    options.view.viewpoint = chosenViewpoint (settings, scene);
    options.first_frame = chosenFrame (settings, scene, 0);
    RunWindow window (std::move (scene), options);
    window.run ();
    return;
  }
  FollowedRun followed (settings, terminal);
  options.view.surface = SurfaceMode::Tsdf;
  options.newScene = [&followed] { return (followed.next ()); };
  RunWindow window (emptyScene (), options);
  saveText ("", (fs::path (settings.follow) / "ready").string ()); // who started this waits for it
  window.run ();
}

#else

void
showWindow (const ViewerSettings& /*settings*/, Terminal& /*terminal*/)
{
  throw IoError ("this program was built without a window; --screenshot FILE.png and --record DIR draw without one");
}

#endif

bool
run (const ViewerSettings& settings, Terminal& terminal)
{
  catchInterruptions ();
  if (settings.needsWindow ())
  {
    showWindow (settings, terminal);
    return (true);
  }
  checkPictures (settings);
  writePictures (settings, loadScene (settings, terminal), terminal);
  return (true);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_viewer", "interrupted; what was written is whole"}, argc, argv,
                      parseViewerCommandLine, run));
}
