// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/process_setting.h"

#include <pcl/console/print.h>

namespace pcl::cosection {

/** \brief No messages of PCL on the console. */
struct ConsoleIsQuiet
{
  using Value = console::VERBOSITY_LEVEL;

  static Value change ()
  {
    const Value before = console::getVerbosityLevel ();
    console::setVerbosityLevel (console::L_ALWAYS);
    return before;
  }

  static void restore (Value before) { console::setVerbosityLevel (before); }
};

/** \brief Keeps PCL's messages from the console while it lives: whatever fails is thrown instead. */
using QuietConsole = ProcessSetting<ConsoleIsQuiet>;

} // namespace pcl::cosection
