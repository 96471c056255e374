// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tool_run.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

using pcl::cosection::test::readFile;

namespace {

const char* const output_name = "tool_stdout.txt";
const char* const error_name = "tool_stderr.txt";

void
redirect (const char* name, int target)
{
  const int file = open (name, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2 (file, target) < 0)
    _exit (126);
  close (file);
}

} // namespace

ToolRun::ToolRun (const std::vector<std::string>& arguments, const std::string& folder,
                  const std::function<void ()>& prepare, const std::string& program)
    : folder_ (folder)
{
  std::vector<std::string> words = {program.empty () ? PCL_COSECTION_TOOL : program};
  words.insert (words.end (), arguments.begin (), arguments.end ());
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back (word.data ());
  pointers.push_back (nullptr);
  process_ = fork ();
  if (process_ < 0)
    throw std::runtime_error ("fork failed");
  if (process_ == 0)
  {
    if (chdir (folder_.c_str ()) != 0)
      _exit (126);
    redirect (output_name, STDOUT_FILENO);
    redirect (error_name, STDERR_FILENO);
    if (prepare)
      prepare ();
    execv (pointers[0], pointers.data ());
    _exit (127);
  }
}

ToolRun::~ToolRun ()
{
  if (ended_)
    return;
  kill (process_, SIGKILL);
  wait ();
}

void
ToolRun::send (int signal) const
{
  if (!ended_)
    kill (process_, signal);
}

bool
ToolRun::waitForError (const std::string& text)
{
  for (int i = 0; i < 1200; ++i)
  {
    if (errors ().find (text) != std::string::npos)
      return (true);
    if (waitpid (process_, &status_, WNOHANG) == process_)
    {
      ended_ = true;
      return (false);
    }
    std::this_thread::sleep_for (std::chrono::milliseconds (50));
  }
  return (false);
}

int
ToolRun::wait ()
{
  if (!ended_)
    waitpid (process_, &status_, 0);
  ended_ = true;
  return (WIFEXITED (status_) ? WEXITSTATUS (status_) : -WTERMSIG (status_));
}

std::string
ToolRun::output () const
{
  return (readFile (folder_ + "/" + output_name));
}

std::string
ToolRun::errors () const
{
  return (readFile (folder_ + "/" + error_name));
}

void
expectErrorLine (const std::string& said, const std::string& name, const std::string& part)
{
  EXPECT_EQ (said.rfind (name + ": error: ", 0), 0u) << said;
  EXPECT_EQ (said.find ('\n'), said.size () - 1) << said;
  EXPECT_NE (said.find (part), std::string::npos) << said;
}

void
expectOneError (const std::string& said, const std::string& part)
{
  EXPECT_NE (said.find (part), std::string::npos) << said;
  int error_lines = 0;
  std::istringstream lines (said);
  for (std::string line; std::getline (lines, line);)
  {
    EXPECT_EQ (line.rfind ("pcl_cosection: ", 0), 0u) << line;
    error_lines += line.rfind ("pcl_cosection: error: ", 0) == 0;
  }
  EXPECT_EQ (error_lines, 1) << said;
}

ToolTest::ToolTest (const std::string& program) : program_ (program.empty () ? PCL_COSECTION_TOOL : program) {}

int
ToolTest::run (const std::vector<std::string>& arguments, const std::function<void ()>& prepare,
               const std::string& program)
{
  ToolRun tool (arguments, path (""), prepare, program.empty () ? program_ : program);
  const int status = tool.wait ();
  output_ = tool.output ();
  errors_ = tool.errors ();
  return (status);
}

std::string
ToolTest::failure (const std::vector<std::string>& arguments, int status)
{
  EXPECT_EQ (run (arguments), status);
  expectErrorLine (errors_, std::filesystem::path (program_).filename ().string ());
  EXPECT_FALSE (std::filesystem::exists (path ("out.pcd")));
  return (errors_);
}
