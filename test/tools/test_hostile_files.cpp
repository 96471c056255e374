// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program among files that are not what it hopes for: whatever fails, it says so in one line, and
// nothing that was there is lost and nothing is left half written.

#include "scene_files.h"
#include "tool_run.h"

#include "common/temporary_folder.h"

#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <map>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

/** \brief A user without rights: files of others that only they may write cannot be written. */
void
dropPrivileges ()
{
  constexpr unsigned int nobody = 65534;
  if (geteuid () == 0 && (setgroups (0, nullptr) != 0 || setgid (nobody) != 0 || setuid (nobody) != 0))
    _exit (125);
}

/** \brief As a full disk: no file grows beyond \a bytes. */
std::function<void ()>
limitFiles (rlim_t bytes)
{
  return ([bytes] {
    const rlimit limit = {bytes, bytes};
    setrlimit (RLIMIT_FSIZE, &limit);
  });
}

class HostileFiles : public testing::Test
{
protected:
  HostileFiles ()
  {
    // In a folder of its own, as what the program prints is a file as well.
    fs::create_directory (folder_.file ("work"));
    writeSphere (path ("sphere.pcd"), 400);
  }

  std::string path (const std::string& name) const { return (folder_.file ("work/" + name)); }

  /** \brief The contents of all files, links as "-> target", folders as "/". */
  std::map<std::string, std::string> everything () const
  {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::recursive_directory_iterator (folder_.file ("work")))
    {
      const std::string name = entry.path ().lexically_relative (folder_.file ("work")).string ();
      if (name.rfind ("tool_std", 0) == 0)
        continue;
      contents[name] = entry.is_symlink ()        ? "-> " + fs::read_symlink (entry.path ()).string ()
                       : entry.is_regular_file () ? test::readFile (entry.path ().string ())
                       : entry.is_directory ()    ? "/"
                                                  : "special";
    }
    return (contents);
  }

  static std::vector<std::string> coarse (std::vector<std::string> arguments)
  {
    arguments.insert (arguments.begin (), {"--resolution", "10", "--threads", "1"});
    return (arguments);
  }

  /** \brief Runs well; \a output is then a mesh. */
  void expectSuccess (const std::vector<std::string>& arguments, const std::string& output) const
  {
    SCOPED_TRACE (testing::PrintToString (arguments));
    ToolRun run (coarse (arguments), folder_.file ("work"));
    EXPECT_EQ (run.wait (), 0) << run.errors ();
    EXPECT_TRUE (isMesh (output));
  }

  bool isMesh (const std::string& name) const
  {
    return (fs::exists (path (name)) && !loadPlyMesh (path (name)).empty ());
  }

  /** \brief Ends with \a status and one line that says \a part; all files are as before. */
  void expectFailure (const std::vector<std::string>& arguments, int status, const std::string& part,
                      const std::function<void ()>& prepare = {}) const
  {
    SCOPED_TRACE (testing::PrintToString (arguments));
    const auto before = everything ();
    ToolRun run (coarse (arguments), folder_.file ("work"), prepare);
    EXPECT_EQ (run.wait (), status);
    expectOneError (run.errors (), part);
    EXPECT_TRUE (everything () == before);
  }

  /** \brief Whether a user without rights can start the program at all. */
  bool canDropPrivileges () const
  {
    fs::permissions (folder_.file ("."), fs::perms (0755));
    ToolRun run ({"--version"}, folder_.file ("work"), dropPrivileges);
    return (run.wait () == 0);
  }

  const test::TemporaryFolder folder_;
};

} // namespace

TEST_F (HostileFiles, InputsThatAreNoFiles)
{
  test::writeFile (path ("empty.pcd"), "");
  ASSERT_EQ (mkfifo (path ("fifo.pcd").c_str (), 0600), 0);
  fs::create_directory (path ("folder.pcd"));
  fs::create_symlink ("nothing", path ("dangling.pcd"));
  fs::create_symlink ("circle.pcd", path ("circle.pcd"));
  expectFailure ({"empty.pcd", "out"}, 1, "empty.pcd: is empty");
  expectFailure ({"fifo.pcd", "out"}, 1, "fifo.pcd: is not a regular file");
  expectFailure ({"folder.pcd", "out"}, 1, "folder.pcd: is a directory");
  expectFailure ({"dangling.pcd", "out"}, 1, "dangling.pcd: no such file");
  expectFailure ({"circle.pcd", "out"}, 1, "circle.pcd: ");
  expectFailure ({"/dev/null", "out"}, 1, "/dev/null: is not a regular file");
  expectFailure ({"sphere.pcd/x.pcd", "out"}, 1, "sphere.pcd/x.pcd: ");
  expectFailure ({"sphere.pcd", "gone.pcd", "out"}, 1, "gone.pcd: no such file");
  expectFailure ({"", "out"}, 1, ": ");
}

TEST_F (HostileFiles, UnreadableInput)
{
  if (!canDropPrivileges ())
    GTEST_SKIP () << "the program cannot be started without rights";
  fs::permissions (path ("sphere.pcd"), fs::perms::none);
  fs::permissions (folder_.file ("work"), fs::perms (0777)); // the output is not the problem
  expectFailure ({"sphere.pcd", "out"}, 1, "sphere.pcd: cannot be read: Permission denied", dropPrivileges);
  fs::permissions (path ("sphere.pcd"), fs::perms (0600)); // to be compared and removed
}

TEST_F (HostileFiles, UnusualNames)
{
  const std::string longest (250, 'n'); // 255 with the extension
  for (const std::string name : {"with space", "ü-Ω-点", "quote\"'$(x)", "two\nlines", "-dash", "\x1b[31mred",
                                 "\xff\xfe", longest.c_str (), "..", "a.b.c"})
  {
    fs::copy_file (path ("sphere.pcd"), path (name + ".pcd"));
    expectSuccess ({"./" + name + ".pcd", "./" + name + ".ply"}, name + ".ply");
    expectSuccess ({"--quiet", "--json=./" + name + ".json", "--", name + ".pcd", name}, name + "/object_1.ply");
    if (name == "..")
      fs::remove (folder_.file ("object_1.ply"));
  }
  expectFailure ({"missing\nfile\x1b[31m.pcd", "out"}, 1, "missing file?[31m.pcd: no such file");
  expectFailure ({longest + "too long.pcd", "out"}, 1, "too long.pcd: ");
  expectFailure ({"sphere.pcd", longest + "too long.ply"}, 1, "too long.ply: ");
  expectFailure ({"sphere.pcd", longest + "too long"}, 1, "too long: ");
  expectFailure ({"sphere.pcd", "out", "--json", longest + "too long"}, 1, "too long: ");
  std::string deep;
  for (int i = 0; i < 30; ++i)
    deep += longest + "/";
  expectFailure ({"sphere.pcd", deep + "out"}, 1, "File name too long");
}

TEST_F (HostileFiles, MissingFoldersAreMadeForTheOutputAlone)
{
  expectFailure ({"sphere.pcd", "no/out.ply"}, 1, "no/out.ply: cannot be written, there is no folder no");
  expectFailure ({"sphere.pcd", "out.ply", "--json", "no/s.json"}, 1, "there is no folder no");
  expectFailure ({"gone.pcd", "some/deep/folder/"}, 1, "gone.pcd"); // what was made is removed again
  expectFailure ({"sphere.pcd", "sphere.pcd/out"}, 1, "sphere.pcd/out: ");
  expectSuccess ({"sphere.pcd", "some/deep/folder/", "--json", "some/deep/s.json"}, "some/deep/folder/object_1.ply");
  EXPECT_TRUE (fs::exists (path ("some/deep/s.json")));
}

TEST_F (HostileFiles, OutputThatIsNoFile)
{
  ASSERT_EQ (mkfifo (path ("fifo.ply").c_str (), 0600), 0);
  fs::create_directory (path ("folder.ply"));
  fs::create_symlink ("circle.ply", path ("circle.ply"));
  test::writeFile (path ("file"), "precious");
  expectFailure ({"sphere.pcd", "fifo.ply"}, 1, "fifo.ply: cannot be written, it is not a regular file");
  expectFailure ({"sphere.pcd", "folder.ply"}, 1, "folder.ply: cannot be written, it is a folder");
  expectFailure ({"sphere.pcd", "circle.ply"}, 1, "circle.ply: ");
  expectFailure ({"sphere.pcd", "/dev/null"}, 1, "/dev/null: ");
  expectFailure ({"sphere.pcd", "file"}, 1, "file: is a file");
  expectFailure ({"sphere.pcd", "out", "--json", "fifo.ply"}, 1, "not a regular file");
  expectFailure ({"sphere.pcd", "out", "--json", "folder.ply"}, 1, "it is a folder");
}

TEST_F (HostileFiles, InputsAreNotOverwritten)
{
  fs::copy_file (path ("sphere.pcd"), path ("input.ply"));
  fs::create_symlink ("sphere.pcd", path ("symbolic.ply"));
  fs::create_hard_link (path ("sphere.pcd"), path ("hard.ply"));
  fs::create_directory (path ("out"));
  fs::create_symlink ("../sphere.pcd", path ("out/object_1.ply"));
  fs::create_directory_symlink (".", path ("here"));
  const std::string why = "is an input that";
  expectFailure ({"input.ply", "input.ply"}, 2, why);
  expectFailure ({"input.ply", "./here/here/input.ply"}, 2, why);
  expectFailure ({"here/input.ply", fs::absolute (path ("input.ply")).string ()}, 2, why);
  expectFailure ({"sphere.pcd", "symbolic.ply"}, 2, why);
  expectFailure ({"sphere.pcd", "hard.ply"}, 2, why);
  expectFailure ({"input.ply", "sphere.pcd", "symbolic.ply"}, 2, why);
  expectFailure ({"sphere.pcd", "out"}, 2, why);
  expectFailure ({"sphere.pcd", "sphere.pcd"}, 2, "a point cloud");
  expectFailure ({"--json", "sphere.pcd", "sphere.pcd", "mesh.ply"}, 2, why);
  expectFailure ({"--json", "hard.ply", "sphere.pcd", "mesh.ply"}, 2, why);
  fs::remove (path ("out/object_1.ply"));
  fs::rename (path ("input.ply"), path ("out/object_7.ply"));
  expectFailure ({"out/object_7.ply", "out"}, 2, why);
  const std::string input = test::readFile (path ("out/object_7.ply"));
  expectSuccess ({"out/object_7.ply", "new.ply", "--json", "out/s.json"}, "new.ply");
  ToolRun run (coarse ({"out/object_7.ply", "out", "--format", "stl"}), folder_.file ("work"));
  EXPECT_EQ (run.wait (), 0) << run.errors ();
  EXPECT_TRUE (fs::exists (path ("out/object_1.stl")));
  EXPECT_EQ (test::readFile (path ("out/object_7.ply")), input);
}

TEST_F (HostileFiles, SummaryAndMeshAreNotTheSameFile)
{
  test::writeFile (path ("old.ply"), "precious");
  fs::create_hard_link (path ("old.ply"), path ("hard"));
  fs::create_symlink ("new.ply", path ("link"));
  fs::create_directory (path ("out"));
  expectFailure ({"--json", "new.ply", "sphere.pcd", "new.ply"}, 2, "--json new.ply: is a file for a mesh");
  expectFailure ({"--json", "./new.ply", "sphere.pcd", "new.ply"}, 2, "is a file for a mesh");
  expectFailure ({"--json", "link", "sphere.pcd", "new.ply"}, 2, "is a file for a mesh");
  expectFailure ({"--json", "hard", "sphere.pcd", "old.ply"}, 2, "is a file for a mesh");
  expectFailure ({"--json", "out/object_1.ply", "sphere.pcd", "out"}, 2, "is a file for a mesh");
  expectFailure ({"--json", "new.vti", "--save-sdf", "sphere.pcd", "new.ply"}, 2, "is a file for a mesh");
}

TEST_F (HostileFiles, LinksOfTheOutputAreFollowed)
{
  fs::create_directories (path ("elsewhere/folder"));
  test::writeFile (path ("elsewhere/old.ply"), "old");
  fs::create_symlink ("elsewhere/old.ply", path ("old.ply"));
  fs::create_symlink ("elsewhere/new.ply", path ("new.ply"));
  fs::create_symlink ("nowhere/new.ply", path ("lost.ply"));
  fs::create_directory_symlink ("elsewhere/folder", path ("folder"));
  fs::create_directory_symlink ("elsewhere/new_folder", path ("new_folder"));
  expectSuccess ({"sphere.pcd", "old.ply"}, "elsewhere/old.ply");
  expectSuccess ({"sphere.pcd", "new.ply"}, "elsewhere/new.ply");
  expectSuccess ({"sphere.pcd", "folder"}, "elsewhere/folder/object_1.ply");
  expectSuccess ({"sphere.pcd", "new_folder"}, "elsewhere/new_folder/object_1.ply");
  for (const char* link : {"old.ply", "new.ply", "folder", "new_folder"})
    EXPECT_TRUE (fs::is_symlink (path (link))) << link;
  expectFailure ({"sphere.pcd", "lost.ply"}, 1, "lost.ply: cannot be written, there is no folder");
}

TEST_F (HostileFiles, WithoutTheRightToWrite)
{
  if (!canDropPrivileges ())
    GTEST_SKIP () << "the program cannot be started without rights";
  fs::create_directory (path ("mine"));
  fs::create_directory (path ("open"));
  for (const char* file : {"mine/old.ply", "open/old.ply", "open/s.json"})
  {
    test::writeFile (path (file), "precious");
    fs::permissions (path (file), fs::perms (0444));
  }
  fs::create_symlink ("../mine/new.ply", path ("open/link.ply"));
  fs::permissions (path ("open"), fs::perms (0777));
  fs::permissions (path ("mine"), fs::perms (0555));
  const std::string why = "cannot be written: Permission denied";
  const auto expectRefusal = [&] (const std::vector<std::string>& arguments) {
    expectFailure (arguments, 1, why, dropPrivileges);
  };
  expectRefusal ({"sphere.pcd", "mine"});
  expectRefusal ({"sphere.pcd", "mine/new.ply"});
  expectRefusal ({"sphere.pcd", "mine/old.ply"});
  expectRefusal ({"sphere.pcd", "open/old.ply"}); // replacing it would be allowed, but is not what its owner wants
  expectRefusal ({"sphere.pcd", "open/link.ply"});
  expectRefusal ({"sphere.pcd", "open/new.ply", "--json", "mine/s.json"});
  expectRefusal ({"sphere.pcd", "open/new.ply", "--json", "open/s.json"});
  expectFailure ({"sphere.pcd", "mine/new/folder"}, 1, "the folder cannot be made: Permission denied", dropPrivileges);
  fs::permissions (path ("mine"), fs::perms (0755)); // to be removed
}

TEST_F (HostileFiles, FullDisk)
{
  test::writeFile (path ("old.ply"), "precious");
  const std::string why = "File too large";
  expectFailure ({"sphere.pcd", "old.ply"}, 1, why, limitFiles (500));
  expectFailure ({"sphere.pcd", "new.stl"}, 1, why, limitFiles (500));
  expectFailure ({"sphere.pcd", "new.obj"}, 1, why, limitFiles (500));
  expectFailure ({"sphere.pcd", "out"}, 1, why, limitFiles (500));
  // The mesh fits, but not its signed distance.
  ToolRun run (coarse ({"--save-sdf", "sphere.pcd", "new.ply"}), folder_.file ("work"), limitFiles (40000));
  EXPECT_EQ (run.wait (), 1);
  expectOneError (run.errors (), "new.vti");
  EXPECT_FALSE (fs::exists (path ("new.vti")));
  EXPECT_TRUE (isMesh ("new.ply"));
}

TEST_F (HostileFiles, OutputFolderVanishes)
{
  writeSphere (path ("large.pcd"), 5000);
  ToolRun run ({"--verbose", "--resolution", "48", "--solver", "fast-jacobi", "--max-iterations", "30", "--tolerance",
                "1e-30", "large.pcd", "out"}, // which takes its time
               folder_.file ("work"));
  ASSERT_TRUE (run.waitForError ("object 1")) << run.errors ();
  fs::remove_all (path ("out"));
  EXPECT_EQ (run.wait (), 1);
  EXPECT_NE (run.errors ().find ("pcl_cosection: error: cannot write 'out/object_1.ply': No such file or directory\n"),
             std::string::npos)
      << run.errors ();
  EXPECT_FALSE (fs::exists (path ("out")));
}
