// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

/** \brief A started pcl_cosection, or another program. */
class ToolRun
{
public:
  /** \param[in] folder its working directory; what it prints goes to files in there
   * \param[in] prepare run in the new process, before the program takes its place
   * \param[in] program path of another program */
  ToolRun (const std::vector<std::string>& arguments, const std::string& folder,
           const std::function<void ()>& prepare = {}, const std::string& program = "");

  /** \brief Kills the program if it is still running. */
  ~ToolRun ();
  ToolRun (const ToolRun&) = delete;
  ToolRun& operator= (const ToolRun&) = delete;

  void send (int signal) const;

  /** \brief Wait until standard error contains \a text. \return false after a minute, or if the
   * program ends before */
  bool waitForError (const std::string& text);

  /** \brief Wait for the end. \return the exit status, or minus the signal that ended the program */
  int wait ();

  std::string output () const;

  std::string errors () const;

private:
  const std::string folder_;
  pid_t process_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

/** \brief What a program said is one line: its name, that it is an error, and \a part. */
void expectErrorLine (const std::string& said, const std::string& name, const std::string& part = "");

/** \brief What pcl_cosection said are lines that begin with its name, one of them an error; \a part is in them. */
void expectOneError (const std::string& said, const std::string& part);

/** \brief A test of a program in a folder of its own. */
class ToolTest : public testing::Test
{
protected:
  /** \param[in] program path of another one than pcl_cosection */
  explicit ToolTest (const std::string& program = "");

  std::string path (const std::string& name) const { return (folder_.file (name)); }

  void write (const std::string& name, const std::string& content) const
  {
    pcl::cosection::test::writeFile (path (name), content);
  }

  std::string read (const std::string& name) const { return (pcl::cosection::test::readFile (path (name))); }

  nlohmann::json json (const std::string& name) const { return (nlohmann::json::parse (read (name))); }

  /** \brief Run in the folder. \param[in] program another one \return the exit status; what it printed is in output_
   * and errors_ */
  int run (const std::vector<std::string>& arguments, const std::function<void ()>& prepare = {},
           const std::string& program = "");

  /** \brief Run to a failure of \a status that is one line and leaves no out.pcd. \return the line */
  std::string failure (const std::vector<std::string>& arguments, int status);

  const pcl::cosection::test::TemporaryFolder folder_;
  std::string output_, errors_;

private:
  const std::string program_;
};
