// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "virtual_display.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace {

const char* const act_program = "/usr/bin/xdotool";

} // namespace

VirtualDisplay::VirtualDisplay ()
{
  std::array<int, 2> ends;
  if (access (act_program, X_OK) != 0 || pipe (ends.data ()) != 0)
    return;
  process_ = fork ();
  if (process_ == 0)
  {
    close (ends[0]);
    const int nothing = open ("/dev/null", O_WRONLY);
    dup2 (nothing, STDOUT_FILENO);
    dup2 (nothing, STDERR_FILENO);
    const std::string fd = std::to_string (ends[1]);
    execlp ("Xvfb", "Xvfb", "-displayfd", fd.c_str (), "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-noreset",
            nullptr);
    _exit (127);
  }
  close (ends[1]);
  char c = 0;
  while (read (ends[0], &c, 1) == 1 && c != '\n')
    name_ += c;
  close (ends[0]);
  if (!name_.empty ())
    name_ = ":" + name_;
}

VirtualDisplay::~VirtualDisplay ()
{
  if (process_ <= 0)
    return;
  kill (process_, SIGTERM);
  waitpid (process_, nullptr, 0);
}

std::function<void ()>
VirtualDisplay::asDisplay () const
{
  return ([name = name_] {
    setenv ("DISPLAY", name.c_str (), 1);
    setenv ("ASAN_OPTIONS", "detect_leaks=0", 1); // where there is a LeakSanitizer, it crashes in threads of drivers
  });
}

std::string
VirtualDisplay::act (const std::vector<std::string>& words) const
{
  ToolRun run (words, folder_.file (""), asDisplay (), act_program);
  run.wait ();
  return (run.output ());
}

std::string
VirtualDisplay::window (const std::string& text) const
{
  for (int n = 0; n < 600; ++n)
  {
    const std::string found = act ({"search", "--name", text});
    if (!found.empty ())
      return (found.substr (0, found.find ('\n')));
    std::this_thread::sleep_for (std::chrono::milliseconds (100));
  }
  return ("");
}
