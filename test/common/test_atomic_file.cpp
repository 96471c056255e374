// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "message_of.h"
#include "temporary_folder.h"

#include "pcl_cosection/common/files.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <stdexcept>

#include <unistd.h>

using namespace pcl::cosection;
using test::messageOf;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

namespace fs = std::filesystem;

TEST (WriteAtomically, CreatesAndReplaces)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("a.txt");
  for (const std::string text : {"first", "second"})
  {
    writeAtomically (path, [&] (const std::string& temporary) {
      EXPECT_EQ (fs::path (temporary).parent_path (), fs::path (path).parent_path ());
      EXPECT_EQ (fs::path (temporary).extension (), ".txt");
      writeFile (temporary, text);
    });
    EXPECT_EQ (readFile (path), text);
    EXPECT_EQ (folder.entries (), 1u);
  }
}

TEST (WriteAtomically, LeavesTheFileAloneIfWritingFails)
{
  const TemporaryFolder folder;
  const auto path = folder.file ("a.txt");
  writeFile (path, "precious");
  EXPECT_THROW (writeAtomically (path,
                                 [] (const std::string& temporary) {
                                   writeFile (temporary, "half");
                                   throw std::runtime_error ("no more");
                                 }),
                std::runtime_error);
  EXPECT_EQ (readFile (path), "precious");
  EXPECT_EQ (folder.entries (), 1u);
}

TEST (WriteAtomically, NamesThePathAndTheReason)
{
  const TemporaryFolder folder;
  const auto nothing = [] (const std::string&) { FAIL () << "must not be called"; };
  const auto missing = folder.file ("missing/a.txt");
  EXPECT_EQ (messageOf<IoError> ([&] { writeAtomically (missing, nothing); }),
             "cannot write '" + missing + "': No such file or directory");
  const auto directory = folder.file ("");
  EXPECT_EQ (messageOf<IoError> ([&] { writeAtomically (directory, nothing); }),
             "cannot write '" + directory + "': Is a directory");
  EXPECT_EQ (messageOf<IoError> ([&] { writeAtomically ("/dev/null", nothing); }),
             "cannot write '/dev/null': not a regular file");
  EXPECT_THROW (writeAtomically ("", nothing), IoError);
  EXPECT_EQ (folder.entries (), 0u);
}

TEST (WriteAtomically, RespectsPermissions)
{
  if (::geteuid () == 0)
    GTEST_SKIP () << "root may write anywhere";
  const TemporaryFolder folder;
  const auto path = folder.file ("a.txt");
  fs::permissions (folder.file (""), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ (messageOf<IoError> ([&] { writeAtomically (path, [] (const std::string&) {}); }),
             "cannot write '" + path + "': Permission denied");
  fs::permissions (folder.file (""), fs::perms::owner_all);
}

TEST (WriteAtomically, FollowsSymbolicLinks)
{
  const TemporaryFolder folder;
  writeFile (folder.file ("target"), "old");
  fs::create_symlink (folder.file ("target"), folder.file ("link"));
  writeAtomically (folder.file ("link"), [] (const std::string& temporary) { writeFile (temporary, "new"); });
  EXPECT_TRUE (fs::is_symlink (folder.file ("link")));
  EXPECT_EQ (readFile (folder.file ("target")), "new");
}

TEST (WriteAtomically, MakesTheFileThatALinkPointsTo)
{
  const TemporaryFolder folder;
  fs::create_directory (folder.file ("elsewhere"));
  fs::create_symlink ("elsewhere/target", folder.file ("link"));
  fs::create_symlink ("link", folder.file ("link_to_link"));
  EXPECT_EQ (followLinks (folder.file ("link_to_link")), folder.file ("elsewhere/target"));
  writeAtomically (folder.file ("link_to_link"), [] (const std::string& temporary) { writeFile (temporary, "new"); });
  EXPECT_TRUE (fs::is_symlink (folder.file ("link")));
  EXPECT_TRUE (fs::is_symlink (folder.file ("link_to_link")));
  EXPECT_EQ (readFile (folder.file ("elsewhere/target")), "new");
  EXPECT_EQ (folder.entries (), 3u);
}

TEST (WriteAtomically, LinksInCirclesAreAnError)
{
  const TemporaryFolder folder;
  fs::create_symlink ("b", folder.file ("a"));
  fs::create_symlink ("a", folder.file ("b"));
  EXPECT_THROW (writeAtomically (folder.file ("a"), [] (const std::string&) {}), IoError);
  EXPECT_THROW (followLinks (folder.file ("a")), IoError);
}
