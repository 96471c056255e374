// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>

namespace pcl::cosection {

/** \brief Keeps PCL's messages from the console while it lives: whatever fails is thrown instead. */
class QuietConsole
{
public:
  QuietConsole () : level_ (console::getVerbosityLevel ()) { console::setVerbosityLevel (console::L_ALWAYS); }
  QuietConsole (const QuietConsole&) = delete;
  QuietConsole& operator= (const QuietConsole&) = delete;
  ~QuietConsole () { console::setVerbosityLevel (level_); }

private:
  console::VERBOSITY_LEVEL level_;
};

} // namespace pcl::cosection
