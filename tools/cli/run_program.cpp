// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include "arguments.h"
#include "exit_status.h"

#include <pcl/cosection/common/error.h>

#include <new>

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
