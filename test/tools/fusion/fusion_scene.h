// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/tool_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/** \brief A folder with the sequence sim: a ball that rolls past a box at rest, twelve frames; rendered once for all
 * tests. pcl_cosection_fusion runs in that folder. */
class FusionScene : public ToolTest
{
protected:
  using Words = std::vector<std::string>;

  static void SetUpTestSuite ();

  FusionScene ();

  /** \brief What goes with the sequence: its poses and masks. */
  static Words known (Words more = {});

  /** \brief It fails with a line that has \a part in it, at its end. */
  void expectFailure (const Words& arguments, int status, const std::string& part);

  std::string file (const std::string& name) const { return (path (name)); }

  bool exists (const std::string& name) const { return (std::filesystem::exists (file (name))); }

  /** \brief Names of all files below a folder, sorted. */
  Words filesIn (const std::string& folder) const;
};
