// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"
#include "tools/tool_run.h"

#include <pcl/cosection/io/mesh_io.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pcl::cosection::test {

using Words = std::vector<std::string>;

/** \brief Runs pcl_cosection_evaluate in a folder of its own. */
class Evaluate : public testing::Test
{
protected:
  /** \brief Run the program. \return the exit status */
  int run (const Words& arguments)
  {
    ToolRun tool (arguments, folder_.file (""), {}, PCL_COSECTION_EVALUATE);
    const int status = tool.wait ();
    output_ = tool.output ();
    errors_ = tool.errors ();
    return (status);
  }

  nlohmann::json json (const std::string& name) const
  {
    return (nlohmann::json::parse (readFile (folder_.file (name))));
  }

  void save (const std::string& name, const TriangleMesh& mesh) const { saveMesh (mesh, folder_.file (name)); }

  /** \brief One line, with the name of the program. */
  void expectOneLine (const std::string& part) const
  {
    EXPECT_EQ (errors_.rfind ("pcl_cosection_evaluate: error: ", 0), 0u) << errors_;
    EXPECT_EQ (std::count (errors_.begin (), errors_.end (), '\n'), 1) << errors_;
    EXPECT_NE (errors_.find (part), std::string::npos) << errors_;
  }

  const TemporaryFolder folder_;
  std::string output_, errors_;
};

} // namespace pcl::cosection::test
