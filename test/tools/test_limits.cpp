// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Limits of the machine: files that cannot grow, closed pipes, what is no file, what killed runs left.

#include "any_cloud_fixture.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

class Limits : public AnyCloud
{
protected:
  Limits () { writeSphere (path ("ball.pcd"), 3000); }

  /** \brief Run \a program with its process prepared. \return the exit status, or minus a signal */
  int runIn (const std::function<void ()>& prepare, const std::vector<std::string>& arguments,
             const std::string& program = "")
  {
    ToolRun tool (arguments, folder_.file (""), prepare, program);
    const int status = tool.wait ();
    output_ = tool.output ();
    errors_ = tool.errors ();
    return status;
  }

  /** \brief Names of files in the folder that begin with a dot. */
  std::vector<std::string> hidden () const
  {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator (path ("")))
      if (entry.path ().filename ().string ()[0] == '.')
        names.push_back (entry.path ().filename ().string ());
    return names;
  }

  static void allowSmallFiles ()
  {
    const rlimit limit{300, 300};
    setrlimit (RLIMIT_FSIZE, &limit);
  }

  static void closeStandardOutput ()
  {
    int ends[2];
    if (pipe (ends) == 0)
    {
      dup2 (ends[1], STDOUT_FILENO);
      close (ends[0]);
      close (ends[1]);
    }
  }
};

} // namespace

TEST_F (Limits, AFileThatCannotGrowIsSaidAndNothingIsLeft)
{
  ASSERT_EQ (run ({"ball.pcd", "ball.ply"}), 0) << errors_;
  const std::vector<std::pair<std::string, std::vector<std::string>>> runs = {
      {"", {"ball.pcd", "out.ply"}},
      {PCL_COSECTION_SEGMENT, {"ball.pcd", "out.pcd"}},
      {PCL_COSECTION_EVALUATE, {"mesh", "--samples", "100", "ball.ply", "ball.ply", "--json", "out.json"}}};
  for (const auto& [program, arguments] : runs)
  {
    EXPECT_EQ (runIn (allowSmallFiles, arguments, program), 1) << program << errors_;
    EXPECT_NE (errors_.find ("cannot"), std::string::npos) << errors_;
    EXPECT_TRUE (hidden ().empty ()) << hidden ().front ();
    if (program != PCL_COSECTION_EVALUATE) // its summary is the reason alone, which is short enough
    {
      EXPECT_FALSE (fs::exists (path (arguments.back ()))) << arguments.back ();
    }
  }
}

TEST_F (Limits, AClosedPipeLosesNoFile)
{
  EXPECT_EQ (runIn (closeStandardOutput, {"ball.pcd", "out.ply"}), 1);
  EXPECT_NE (errors_.find ("standard output cannot be written"), std::string::npos) << errors_;
  EXPECT_GT (volume ("out.ply"), 0.0);
  EXPECT_EQ (runIn (closeStandardOutput, {"mesh", "--samples", "100", "out.ply", "out.ply"}, PCL_COSECTION_EVALUATE),
             1);
  EXPECT_EQ (runIn (closeStandardOutput, {"--help"}), 1);
}

TEST_F (Limits, WhatIsNoFileIsSaidAtOnce)
{
  for (const char* name : {"pipe.ply", "pipe.txt", "pipe.json", "pipe.cfg"})
    ASSERT_EQ (mkfifo (path (name).c_str (), 0600), 0);
  fs::create_symlink ("/dev/zero", path ("zero.ply"));
  fs::create_symlink ("/dev/zero", path ("zero.cfg"));
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--obstacle", "pipe.ply"},
                                                  {"--obstacle", "zero.ply"},
                                                  {"--object-trajectory", "1=pipe.txt"},
                                                  {"--config", "pipe.cfg"},
                                                  {"--config", "zero.cfg"}})
  {
    std::vector<std::string> arguments = options;
    arguments.insert (arguments.end (), {"ball.pcd", "out.ply"});
    EXPECT_EQ (run (arguments), options[0] == "--config" ? 2 : 1) << options[1];
    EXPECT_NE (errors_.find ("not a regular file"), std::string::npos) << errors_;
  }
  EXPECT_NE (runIn ({}, {"pipe.json", "out"}, PCL_COSECTION_SIMULATE), 0);
  EXPECT_NE (errors_.find ("not a regular file"), std::string::npos) << errors_;
}

TEST_F (Limits, WhatAKilledRunLeftIsRemoved)
{
  const std::string gone = "999999999"; // more than any number of a process
  const std::string own = std::to_string (getpid ());
  write (".cosection-" + gone + "-0.tmp.ply", "part of a mesh");
  write (".cosection-" + own + "-0.tmp.ply", "of a process that lives");
  fs::create_directories (path (".scene_" + gone + "_abcdef"));
  fs::create_directories (path (".scene_" + own + "_abcdef"));
  fs::create_directories (path (".scene_" + gone + "_" + own + "_abcdef")); // of scene_999999999
  ASSERT_EQ (run ({"ball.pcd", "out.ply"}), 0) << errors_;
  ASSERT_EQ (runIn ({}, {"--preset", "table", "--frames", "0:1", "scene"}, PCL_COSECTION_SIMULATE), 0) << errors_;
  std::vector<std::string> left = hidden ();
  std::sort (left.begin (), left.end ());
  std::vector<std::string> expected = {".cosection-" + own + "-0.tmp.ply", ".scene_" + gone + "_" + own + "_abcdef",
                                       ".scene_" + own + "_abcdef"};
  std::sort (expected.begin (), expected.end ());
  EXPECT_EQ (left, expected);
}

TEST_F (Limits, TheConfigurationIsAnInput)
{
  write ("c.obj", "resolution = 20\n");
  write ("c.json", "resolution = 20\n");
  EXPECT_EQ (run ({"--config", "c.obj", "ball.pcd", "c.obj"}), 2);
  EXPECT_EQ (run ({"--config=c.json", "--json", "c.json", "ball.pcd", "out.ply"}), 2);
  EXPECT_EQ (test::readFile (path ("c.obj")), "resolution = 20\n");
  EXPECT_EQ (test::readFile (path ("c.json")), "resolution = 20\n");
  write ("a.cfg", "=\n");
  write ("b.cfg", "plane = \"0,0,1,1\n");
  write ("d.cfg", "json = " + std::string (2000000, 'x'));
  for (const char* name : {"a.cfg", "b.cfg", "d.cfg"})
  {
    EXPECT_EQ (run ({"--config", name, "ball.pcd", "out.ply"}), 2) << name;
    EXPECT_LT (errors_.size (), 3000u) << name;
  }
}

TEST_F (Limits, BracketsWithinBracketsAreRefused)
{
  constexpr int deep = 200000;
  write ("scene.json", "{\"description\":" + std::string (deep, '[') + std::string (deep, ']') + ",\"frames\":1}");
  EXPECT_EQ (runIn ({}, {"scene.json", "out"}, PCL_COSECTION_SIMULATE), 1);
  EXPECT_NE (errors_.find ("too many brackets"), std::string::npos) << errors_;
}
