// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include "arguments.h"

#include <pcl/cosection/common/error.h>

#include <csignal>
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

} // namespace

std::string
describe (const std::exception& error, const std::string& out_of_memory)
{
  return (dynamic_cast<const std::bad_alloc*> (&error) ? out_of_memory : error.what ());
}

int
runProgram (const Program& program, const std::function<bool (Terminal&)>& work)
{
  Terminal terminal (program.name);
  try
  {
    return (work (terminal) ? Success : Failure);
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
  std::signal (SIGXFSZ, SIG_IGN); // writing fails instead, as on a full disk
}

bool
interrupted ()
{
  return (signal_received != 0);
}
