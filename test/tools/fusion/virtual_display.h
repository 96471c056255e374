// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"
#include "tools/tool_run.h"

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

/** \brief An X server without a screen (Xvfb), and someone at it who presses keys and moves the mouse (xdotool). */
class VirtualDisplay
{
public:
  VirtualDisplay ();
  ~VirtualDisplay ();
  VirtualDisplay (const VirtualDisplay&) = delete;
  VirtualDisplay& operator= (const VirtualDisplay&) = delete;

  /** \brief ":1"; empty: there is none, for the programs are not installed. */
  const std::string& name () const { return (name_); }

  /** \brief To give to ToolRun: the program has this display. */
  std::function<void ()> asDisplay () const;

  /** \brief Run xdotool. \return what it prints */
  std::string act (const std::vector<std::string>& words) const;

  /** \brief The window whose title has \a text in it; empty after a minute without one. */
  std::string window (const std::string& text) const;

private:
  const pcl::cosection::test::TemporaryFolder folder_;
  pid_t process_ = -1;
  std::string name_;
};
