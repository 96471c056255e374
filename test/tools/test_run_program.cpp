// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// How every program ends, whatever its work throws.

#include "arguments.h"
#include "run_program.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <new>
#include <stdexcept>

using namespace pcl::cosection;

namespace {

/** \brief The exit status and what was said of it. */
std::pair<int, std::string>
ending (const std::function<bool ()>& work, const Program& program = {"prog", "stopped", "no memory"})
{
  testing::internal::CaptureStderr ();
  const int status = runProgram (program, [&] (Terminal&) { return (work ()); });
  return {status, testing::internal::GetCapturedStderr ()};
}

template <typename Error>
std::function<bool ()>
throwing (const Error& error)
{
  return ([error] () -> bool { throw error; });
}

using Ending = std::pair<int, std::string>;

} // namespace

TEST (RunProgram, WhatTheWorkSays)
{
  EXPECT_EQ (ending ([] { return (true); }), Ending (0, ""));
  EXPECT_EQ (ending ([] { return (false); }), Ending (1, "")); // it has told why
}

TEST (RunProgram, ErrorsAreOneLine)
{
  EXPECT_EQ (ending (throwing (UsageError ("what?"))), Ending (2, "prog: error: what?\n"));
  EXPECT_EQ (ending (throwing (IoError ("a.pcd: is\nno file"))), Ending (1, "prog: error: a.pcd: is no file\n"));
  EXPECT_EQ (ending (throwing (std::runtime_error ("else"))), Ending (1, "prog: error: else\n"));
  EXPECT_EQ (ending (throwing (Cancelled ("by a signal"))), Ending (130, "prog: error: stopped\n"));
  EXPECT_EQ (ending (throwing (std::bad_alloc ())), Ending (1, "prog: error: no memory\n"));
  EXPECT_EQ (ending (throwing (std::bad_alloc ()), {"prog"}), Ending (1, "prog: error: out of memory\n"));
}

TEST (RunProgram, ErrorsAreToldToTheQuietToo)
{
  testing::internal::CaptureStderr ();
  const int status = runProgram ({"prog"}, [] (Terminal& terminal) -> bool {
    terminal.setVerbosity (Verbosity::Quiet);
    throw IoError ("lost");
  });
  EXPECT_EQ (status, 1);
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "prog: error: lost\n");
}

TEST (RunProgram, NoFileTakesThePlaceOfAClosedStream)
{
  const pid_t child = fork ();
  ASSERT_GE (child, 0);
  if (child == 0)
  {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      close (stream);
    bool is_apart = false, is_usable = true;
    runProgram ({"prog"}, [&] (Terminal&) {
      is_apart = open ("/dev/zero", O_RDWR) > STDERR_FILENO;
      is_usable = write (STDOUT_FILENO, "x", 1) == 1 || write (STDERR_FILENO, "x", 1) == 1;
      return (true);
    });
    _exit (is_apart && !is_usable ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ (waitpid (child, &status, 0), child);
  EXPECT_EQ (status, 0);
}
