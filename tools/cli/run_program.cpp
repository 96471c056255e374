// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include "arguments.h"

#include <pcl/cosection/common/error.h>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <new>

namespace {

enum ExitStatus
{
  Success = 0,
  Failure = 1,
  WrongUsage = 2,
  Interrupted = 130,
};

volatile std::sig_atomic_t signal_received = 0;

extern "C" void
rememberSignal (int)
{
  signal_received = 1;
}

/** \brief Give the numbers of closed standard streams to something that cannot be used: else the next file that is
 * opened gets one of them, and what is said goes into it. */
void
occupyClosedStreams ()
{
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl (stream, F_GETFD) < 0 && open ("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
      return; // no file can be opened at all
}

} // namespace

std::string
describe (const std::exception& error, const std::string& out_of_memory)
{
  return (dynamic_cast<const std::bad_alloc*> (&error) ? out_of_memory : error.what ());
}

int
runProgram (const Program& program, const std::function<bool (Terminal&)>& work)
{
  occupyClosedStreams ();
  // Writing fails instead, as on a full disk: what is computed is still written to files.
  std::signal (SIGXFSZ, SIG_IGN);
  std::signal (SIGPIPE, SIG_IGN);
  Terminal terminal (program.name);
  try
  {
    const bool all_went_well = work (terminal);
    if (std::cout.flush ())
      return (all_went_well ? Success : Failure);
    terminal.error ("standard output cannot be written");
    return (Failure);
  }
  catch (const UsageError& error)
  {
    terminal.error (error.what ());
    return (WrongUsage);
  }
  catch (const pcl::cosection::Cancelled&)
  {
    terminal.error (program.interrupted);
    return (Interrupted);
  }
  catch (const std::exception& error)
  {
    terminal.error (describe (error, program.out_of_memory));
  }
  return (Failure);
}

void
catchInterruptions ()
{
  struct sigaction action = {};
  action.sa_handler = rememberSignal;
  action.sa_flags = SA_RESTART | static_cast<int> (SA_RESETHAND);
  sigemptyset (&action.sa_mask);
  sigaction (SIGINT, &action, nullptr);
  sigaction (SIGTERM, &action, nullptr);
  sigaction (SIGHUP, &action, nullptr); // the terminal was closed
}

bool
interrupted ()
{
  return (signal_received != 0);
}
