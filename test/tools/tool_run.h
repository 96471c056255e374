// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
