// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Limits of the machine: files that cannot grow, closed pipes, what is no file, what killed runs left.

#include "any_cloud_fixture.h"
#include "output_files.h"

#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>

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

  /** \brief As a limit of a container: so many threads can be made. Needs the right to become another user. */
  static void allowThreads (rlim_t beside_the_first)
  {
    const rlimit limit{1 + beside_the_first, 1 + beside_the_first};
    if (setrlimit (RLIMIT_NPROC, &limit) != 0 || setuid (nobody) != 0)
      _exit (cannot_prepare);
    setenv ("ASAN_OPTIONS", "detect_leaks=0", 1); // where there is a LeakSanitizer, it wants a thread of its own
  }

  static constexpr uid_t nobody = 64999; // no process is its
  static constexpr int cannot_prepare = 120, cannot_execute = 127;

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

TEST_F (Limits, FewerThreadsThanAreWanted)
{
  if (getuid () != 0)
    GTEST_SKIP () << "only root can become a user without processes";
  fs::permissions (path (""), fs::perms::all);
  ASSERT_EQ (run ({"--threads", "1", "ball.pcd", "one.ply"}), 0) << errors_;
  for (const rlim_t threads : {0, 1, 2})
  {
    const std::string out = "of_" + std::to_string (threads) + ".ply";
    const int status = runIn ([&] { allowThreads (threads); }, {"--threads", "4", "ball.pcd", out});
    if (status == cannot_prepare || status == cannot_execute)
      GTEST_SKIP () << "another user may not run the program";
    ASSERT_EQ (status, 0) << errors_;
    EXPECT_EQ (test::readFile (path (out)), test::readFile (path ("one.ply")));
  }
}

TEST_F (Limits, LittleMemoryIsSaid)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP () << "a sanitizer takes terabytes of addresses";
#endif
  // Less, and Debian 12 could not load the libraries.
  const auto allowLittleMemory = [] {
    const rlimit limit{110000 * 1024, 110000 * 1024};
    setrlimit (RLIMIT_AS, &limit);
  };
  EXPECT_EQ (runIn (allowLittleMemory, {"--threads", "4", "ball.pcd", "out.ply"}), 1);
  EXPECT_NE (errors_.find ("fewer threads (--threads)"), std::string::npos) << errors_;
  EXPECT_FALSE (fs::exists (path ("out.ply")));
  EXPECT_TRUE (hidden ().empty ());
}

TEST_F (Limits, ADamagedInstalledNetwork)
{
  fs::create_directories (path ("bin"));
  fs::create_directories (path ("share/pcl_cosection"));
  const std::string program = path ("bin/pcl_cosection");
  fs::copy_file (PCL_COSECTION_TOOL, program);
  ASSERT_EQ (runIn ({}, {"ball.pcd", "without.ply"}, program), 0) << errors_;
  EXPECT_EQ (errors_.find ("learned"), std::string::npos) << errors_;
  write ("share/pcl_cosection/completion.onnx", "no network");
  ASSERT_EQ (runIn ({}, {"ball.pcd", "damaged.ply"}, program), 0) << errors_;
  EXPECT_NE (errors_.find ("the learned prior is off"), std::string::npos) << errors_;
  EXPECT_EQ (test::readFile (path ("damaged.ply")), test::readFile (path ("without.ply")));
}

TEST_F (Limits, AFaceOfManyCorners)
{
  constexpr int corners = 100000;
  std::ostringstream face;
  face << "ply\nformat ascii 1.0\nelement vertex " << corners
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
          "property list uint int vertex_indices\nend_header\n";
  for (int n = 0; n < corners; ++n)
  {
    const double angle = 2.0 * M_PI * n / corners, radius = 1.0 + 0.5 * (n % 2);
    face << radius * std::cos (angle) << ' ' << radius * std::sin (angle) << " 0\n";
  }
  face << corners;
  for (int n = 0; n < corners; ++n)
    face << ' ' << n;
  write ("star.ply", face.str () + "\n");
  const auto endlessRunsEnd = [] {
    const rlimit limit{300, 300};
    setrlimit (RLIMIT_CPU, &limit);
  };
  EXPECT_EQ (runIn (endlessRunsEnd, {"--obstacle", "star.ply", "ball.pcd", "out.ply"}), 0) << errors_;
}

TEST_F (Limits, WhatIsWrittenToTryAFolderIsATemporaryFile)
{
  const int watch = inotify_init1 (IN_NONBLOCK);
  ASSERT_GE (watch, 0);
  ASSERT_GE (inotify_add_watch (watch, path ("").c_str (), IN_CREATE), 0);
  requireWritable (path ("out.ply"));
  alignas (inotify_event) char events[4096] = {};
  const ssize_t size = ::read (watch, events, sizeof (events));
  close (watch);
  ASSERT_GT (size, 0);
  // By such a name the next run knows what is left of one that was killed.
  const std::string name = reinterpret_cast<const inotify_event*> (events)->name;
  EXPECT_EQ (name.rfind (".cosection-" + std::to_string (getpid ()) + "-", 0), 0u) << name;
  EXPECT_TRUE (hidden ().empty ());
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
