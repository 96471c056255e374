// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// Prints the manual page of pcl_cosection, which says what --help says. Part of the build, not installed.

#include "option_table.h"
#include "program_text.h"

#include <iostream>

int
main ()
{
  CLI::App app;
  Given given;
  declareOptions (app, given);
  std::cout << manPage (app, completionText ()) << std::flush;
  return (std::cout ? 0 : 1);
}
